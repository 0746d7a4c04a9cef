// A run's files, read back as other programs read them.
#include "output/run_output.h"

#include "base/error.h"
#include "base/file_size_limit.h"
#include "base/scratch_folder.h"
#include "geometry/mesh/edge_division.h"
#include "output/recorded_run.h"
#include "output/run_recorder.h"
#include "output/small_world.h"
#include "simulation/model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <utility>

namespace sprung {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using testing::FileSizeLimit;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::listing;
using ::testing::Not;
using testing::read_text;
using testing::ScratchFolder;
using testing::small_world;
using testing::still;

/// The lines of an OBJ file by their first word, and its positions as a reader with strtod sees them.
struct ObjLines {
  std::vector<std::string> order;
  std::vector<std::string> faces;
  std::vector<double> positions;
};

ObjLines read_lines(const std::filesystem::path& file) {
  ObjLines lines;
  std::istringstream stream(read_text(file));
  for (std::string line; std::getline(stream, line);) {
    const std::string word = line.substr(0, line.find(' '));
    lines.order.push_back(word);
    if (word != "v") {
      lines.faces.push_back(line);
      continue;
    }
    const char* text = line.c_str() + 1;
    for (int axis = 0; axis < 3; ++axis) {
      char* end = nullptr;
      lines.positions.push_back(std::strtod(text, &end));
      text = end;
    }
  }
  return lines;
}

class RunOutputFiles : public ::testing::Test {
 protected:
  RunOutput open(int frames, const std::string& scene = "") {
    return {
        OutputFolder(scratch_ / "out", false), {.scene = scene, .frames = frames, .steps_per_frame = 2, .threads = 3}, simulator_};
  }
  void run(int frames) {
    RunOutput output = open(frames);
    FrameRunner runner(simulator_);
    output.write_frame(simulator_, runner.first_frame());
    for (int frame = 2; frame <= frames; ++frame) output.write_frame(simulator_, runner.next_frame());
    output.finish("done");
  }
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return scratch_ / ("out/" + name); }
  [[nodiscard]] nlohmann::json summary() const { return nlohmann::json::parse(read_text(file("run.json"))); }

  ScratchFolder scratch_;
  Simulator simulator_ = small_world();
};

TEST_F(RunOutputFiles, AreThoseOfTheContract) {
  run(2);
  EXPECT_THAT(listing(scratch_ / "out"),
              ElementsAre("cloth/", "cloth/cloth.0001.obj", "cloth/cloth.0002.obj", "diagnostics.csv", "house/",
                          "house/house.0001.obj", "house/house.0002.obj", "obstacles/", "obstacles/ball.obj", "obstacles/floor.obj",
                          "obstacles/lift/", "obstacles/lift/lift.0001.obj", "obstacles/lift/lift.0002.obj", "record.bin", "rope/",
                          "rope/rope.0001.obj", "rope/rope.0002.obj", "run.json"));
}

TEST_F(RunOutputFiles, FrameOneIsTheStateAtTimeZeroAndEachNumberReadsBackEqual) {
  RunOutput output = open(3);
  FrameRunner runner(simulator_);
  for (int frame = 1; frame <= 3; ++frame) {
    output.write_frame(simulator_, frame == 1 ? runner.first_frame() : runner.next_frame());
    output.flush();
    for (const Body& body : simulator_.network().bodies) {
      const std::vector<double> read =
          read_lines(file(body.name + "/" + body.name + ".000" + std::to_string(frame) + ".obj")).positions;
      const Points expected = (frame == 1 ? simulator_.network().positions : simulator_.positions())
                                  .middleCols(body.first_particle, body.particle_count);
      EXPECT_EQ(read, std::vector<double>(expected.data(), expected.data() + expected.size())) << body.name << " " << frame;
    }
  }
}

TEST_F(RunOutputFiles, LinesKeepTheirCountsAndOrderInEachFrame) {
  run(3);
  for (const Body& body : simulator_.network().bodies) {
    const std::string name = body.name + "/" + body.name;
    const ObjLines first = read_lines(file(name + ".0001.obj"));
    EXPECT_EQ(first.positions.size(), 3U * body.particle_count);
    for (const char* later : {".0002.obj", ".0003.obj"}) {
      const ObjLines frame = read_lines(file(name + later));
      EXPECT_EQ(frame.order, first.order);
      EXPECT_EQ(frame.faces, first.faces);
      EXPECT_NE(frame.positions, first.positions);
    }
  }
}

/// A tetrahedron of 1 m in a cell, with edges divided for contact.
Simulator coarse_world(const PolygonMesh& tetrahedron) {
  LatticeShape lattice{.surface = tetrahedron,
                       .contact = divide_long_edges({tetrahedron.vertices, triangulate(tetrahedron.faces)}, 0.3),
                       .cells = {{{0, 0, 0}, 1.0}}};
  BodyShape shape = make_lattice_body(lattice, {});
  set_total_mass(shape, 1.0);
  NetworkBuilder builder;
  builder.add_body("coarse", shape);
  return Simulator(builder.build(), {.step = 0.01});
}

TEST(CoarseLattices, HaveTheVerticesFacesAndNormalsOfTheirMeshInFrames) {
  const std::string text = "v 0.1 0.1 0.1\nv 0.9 0.1 0.1\nv 0.1 0.9 0.1\nv 0.1 0.1 0.9\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const ScratchFolder scratch;
  std::ofstream(scratch / "coarse.obj") << text;
  const PolygonMesh mesh = read_obj(scratch / "coarse.obj");
  const Simulator simulator = coarse_world(mesh);
  const Body& body = simulator.network().bodies[0];
  ASSERT_GT(body.contact_vertex_count(), 4);
  EXPECT_EQ(body.exported_vertex_count(), 4);
  const auto obj_text = [&](const ObjSources& sources) {
    const RunRecorder recorder(simulator, sources, {});
    return make_exporter("obj", {.model = recorder.model()})->frame({.state = RunRecorder::frame(simulator)}).front().bytes;
  };
  EXPECT_EQ(obj_text({}), text);
  const ObjSource source{.file = ObjTemplate(text, ObjTemplate::Normals::per_vertex), .particle_of = {}, .faces = mesh.faces};
  EXPECT_EQ(obj_text({{"coarse", std::make_shared<ObjSource>(source)}}), source.text(mesh.vertices, triangulate(mesh.faces)));
  EXPECT_EQ(RunRecorder(simulator, {}, {}).model().bodies[0].particle_of, (std::vector<Index>{0, 1, 2, 3}));
}

/// A strip of four quads along x in the x-y plane, written from its file, and a cloth of the same size: both are pulled apart.
Simulator torn_world() {
  SpringMaterial material{.value = 10.0, .break_strain = 0.2};
  PolygonMesh mesh;
  mesh.vertices.resize(3, 10);
  for (Index i = 0; i < 10; ++i) mesh.vertices.col(i) = Vector3(i % 5, i / 5, 0.0);
  for (Index i = 0; i < 4; ++i) {
    mesh.faces.vertex.insert(mesh.faces.vertex.end(), {i, i + 1, i + 6, i + 5});
    mesh.faces.corner_begin.push_back(4 * (i + 1));
  }
  mesh.lines.resize(2, 0);
  NetworkBuilder builder;
  for (const auto& [name, made] :
       {std::pair("strip", make_mesh_body(mesh, {.structural = material})),
        std::pair("cloth", make_cloth({.size = {4.0, 1.0}, .resolution = {5, 2}}, {.structural = material}))}) {
    BodyShape shape = made;
    set_total_mass(shape, 1.0);
    for (std::size_t i = 0; i < shape.positions.size(); ++i) {
      if (shape.positions[i].x() == shape.positions[4].x()) shape.velocities[i] = {10.0, 0.0, 0.0};
    }
    builder.add_body(name, shape, {}, {.others = false});
  }
  SimulatorSettings settings;
  settings.step = 0.01;
  settings.gravity.setZero();
  return Simulator(builder.build(), settings);
}

TEST(TornBodies, LoseFacesAndKeepVertices) {
  ScratchFolder scratch;
  Simulator simulator = torn_world();
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 4 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 3 1 0\nv 4 1 0\n"
      "f 1 2 7 6\nf 2 3 8 7\nf 3 4 9 8\nf 4 5 10 9\n";
  const ObjSources sources{
      {"strip", std::make_shared<ObjSource>(ObjSource{.file = ObjTemplate(text, ObjTemplate::Normals::as_given),
                                                      .particle_of = {},
                                                      .faces = simulator.network().bodies[0].surface.faces})}};
  constexpr int kFrames = 12;
  RunOutput output(OutputFolder(scratch / "out", false), {.frames = kFrames, .steps_per_frame = 1, .sources = sources}, simulator);
  FrameRunner runner(simulator);
  std::map<std::string, std::vector<Index>> torn;
  nlohmann::json expected = nlohmann::json::array();
  for (int frame = 1; frame <= kFrames; ++frame) {
    output.write_frame(simulator, frame == 1 ? runner.first_frame() : runner.next_frame());
    output.flush();
    for (const Body& body : simulator.network().bodies) {
      char name[32];
      std::snprintf(name, sizeof name, "%04d.obj", frame);
      const PolygonMesh written = read_obj(scratch / ("out/" + body.name + "/" + body.name + "." + name));
      EXPECT_EQ(written.vertices, simulator.positions().middleCols(body.first_particle, 10)) << body.name << frame;
      EXPECT_EQ(written.faces.vertex, without_faces(body.surface.faces, body.surface.torn).vertex) << body.name << frame;
      const std::vector<Index> now = body.surface.torn;
      std::vector<Index> faces;
      std::ranges::set_difference(now, torn[body.name], std::back_inserter(faces));
      torn[body.name] = now;
      if (!faces.empty()) expected.push_back({{"body", body.name}, {"frame", frame}, {"faces", faces}});
    }
  }
  output.finish("done");
  EXPECT_THAT(torn["strip"], ElementsAre(3)) << "the last quad of four";
  EXPECT_THAT(torn["cloth"], Contains(6)) << "one of the last triangles of eight";
  EXPECT_EQ(nlohmann::json::parse(read_text(scratch / "out/run.json"))["torn_faces"], expected);

  const RecordedRun recorded(scratch / "out");
  std::set<std::pair<Index, Index>> broken;
  const RecordedSprings& springs = recorded.model().springs;
  for (const BrokenSprings& now : recorded.broken_springs()) {
    for (const Index s : now.springs) broken.insert({springs.ends(0, s), springs.ends(1, s)});
  }
  std::set<std::pair<Index, Index>> gone;
  const Springs& whole = simulator.model()->network().springs;
  for (Index s = 0; s < whole.count(); ++s) {
    if (simulator.state().springs.is_broken(s)) gone.insert({whole.first[s], whole.second[s]});
  }
  ASSERT_FALSE(gone.empty());
  EXPECT_EQ(broken, gone);
  EXPECT_EQ(springs.ends.cols(), whole.count()) << "the record has all that there were";
}

/// A tetrahedron whose tip goes from 1 m to 3 m in a quarter of a second, and which is driven along x.
Simulator world_of_a_deforming_obstacle() {
  NetworkBuilder builder;
  builder.begin_body("ball", {});
  builder.add_particle({0.0, 10.0, 0.0}, 1.0);
  MeshSequence sequence{.triangles = Triangles(3, 4), .frames = {Points(3, 4), Points(3, 4)}, .frame_rate = 4.0};
  sequence.triangles << 0, 0, 0, 1, 1, 2, 3, 2, 3, 1, 2, 3;
  sequence.frames[0] << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  sequence.frames[1] << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 3;
  Obstacle obstacle = still("heart", SequenceGeometry{std::make_shared<const MeshSequence>(sequence), true}, {0.0, 0.0, 0.0});
  obstacle.motion.keyframes = {{.time = 0.0}, {.time = 1.0, .position = {8.0, 0.0, 0.0}}};
  return Simulator(builder.build(), {.step = 1.0 / 16.0, .steps_per_frame = 2}, {obstacle});
}

TEST(RunOutput, DeformingObstaclesAreWrittenAsTheyAreInEachFrame) {
  const ScratchFolder scratch;
  Simulator simulator = world_of_a_deforming_obstacle();
  RunOutput output(OutputFolder(scratch / "out", false), {.frames = 3, .steps_per_frame = 2, .threads = 1}, simulator);
  FrameRunner runner(simulator);
  // Eighths of a second: the tip goes 1 m and the whole 1 m in each frame, in numbers that are exact.
  for (int frame = 1; frame <= 3; ++frame) {
    output.write_frame(simulator, frame == 1 ? runner.first_frame() : runner.next_frame());
    output.flush();
    const double moved = frame - 1.0;
    const ObjLines lines = read_lines(scratch / ("out/obstacles/heart/heart.000" + std::to_string(frame) + ".obj"));
    EXPECT_THAT(lines.positions, ElementsAre(moved, 0, 0, 1.0 + moved, 0, 0, moved, 1, 0, moved, 0, 1.0 + moved)) << frame;
    EXPECT_THAT(lines.faces, ElementsAre("f 1 2 4", "f 1 3 2", "f 1 4 3", "f 2 3 4"));
  }
  output.finish("done");
}

TEST_F(RunOutputFiles, RopesAreLines) {
  run(1);
  EXPECT_THAT(read_lines(file("rope/rope.0001.obj")).faces, ElementsAre("l 1 2", "l 2 3", "l 3 4"));
}

TEST_F(RunOutputFiles, ClothsAreTriangles) {
  run(1);
  const std::vector<std::string> faces = read_lines(file("cloth/cloth.0001.obj")).faces;
  EXPECT_EQ(faces.size(), 2U * 2U * 3U);
  EXPECT_THAT(faces, Each(::testing::MatchesRegex("f [0-9]+ [0-9]+ [0-9]+")));
}

TEST_F(RunOutputFiles, MeshBodiesKeepPolygonsGroupsAndUvs) {
  run(1);
  EXPECT_THAT(
      read_lines(file("house/house.0001.obj")).faces,
      ElementsAre("vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1", "vt 0.5 0.1", "g wall", "f 1/1 2/2 3/3 4/4", "g roof", "f 4/4 3/3 5/5"));
}

TEST_F(RunOutputFiles, ObstaclesAreWhereTheyArePlacedAndWhereTheyMove) {
  run(3);
  const auto box_of = [&](const std::string& name) {
    const std::vector<double> read = read_lines(file("obstacles/" + name)).positions;
    return bounds(Eigen::Map<const Points>(read.data(), 3, static_cast<Eigen::Index>(read.size() / 3)));
  };
  // The poles of a tessellated sphere are vertices: exact but for rounding.
  EXPECT_NEAR(box_of("ball.obj").min().y(), 0.1, 1e-15);
  EXPECT_NEAR(box_of("ball.obj").max().y(), 0.5, 1e-15);
  EXPECT_TRUE(box_of("lift/lift.0001.obj").isApprox(Box3(Vector3(2.9, 0.4, 4.9), Vector3(3.1, 0.6, 5.1)), 1e-15));
  // Two frames of two steps of 0.01 s later it rose by 0.04 * 0.25 m.
  EXPECT_TRUE(box_of("lift/lift.0003.obj").isApprox(Box3(Vector3(2.9, 0.41, 4.9), Vector3(3.1, 0.61, 5.1)), 1e-15));
}

TEST_F(RunOutputFiles, FloorReachesUnderTheWholeScene) {
  run(1);
  const std::vector<double> read = read_lines(file("obstacles/floor.obj")).positions;
  const Box3 floor = bounds(Eigen::Map<const Points>(read.data(), 3, static_cast<Eigen::Index>(read.size() / 3)));
  const Box3 scene = bounds(simulator_.network().positions);
  for (const int axis : {0, 2}) {
    EXPECT_LT(floor.min()[axis], scene.min()[axis]);
    EXPECT_GT(floor.max()[axis], scene.max()[axis]);
  }
  EXPECT_EQ(floor.sizes().y(), 0.0);
}

TEST_F(RunOutputFiles, DigitsGrowWithTheNumberOfFrames) {
  RunOutput output = open(100'000);
  output.write_frame(simulator_, FrameRunner(simulator_).first_frame());
  output.flush();
  EXPECT_TRUE(std::filesystem::exists(file("rope/rope.000001.obj")));
}

TEST_F(RunOutputFiles, DiagnosticsHaveARowAFrame) {
  run(4);
  std::istringstream stream(read_text(file("diagnostics.csv")));
  std::vector<std::string> starts;
  for (std::string line; std::getline(stream, line);) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 16);
    starts.push_back(line.substr(0, line.find(',', line.find(',') + 1)));
  }
  EXPECT_THAT(starts, ElementsAre("frame,time", "1,0", "2,0.02", "3,0.04", "4,0.06"));
}

TEST_F(RunOutputFiles, SummaryTellsTheSeedIfThereIsOne) {
  run(1);
  EXPECT_TRUE(summary()["seed"].is_null());
  const RunOutput output(OutputFolder(scratch_ / "out", true), {.seed = 7}, simulator_);
  EXPECT_EQ(summary()["seed"], 7);
}

TEST_F(RunOutputFiles, SummaryReportsTheProgressOfTheRun) {
  RunOutput output = open(3, R"({"duration": 0.1, "bodies": {}})");
  EXPECT_EQ(summary()["outcome"], "running");
  EXPECT_EQ(summary()["frames_written"], 0);
  FrameRunner runner(simulator_);
  output.write_frame(simulator_, runner.first_frame());
  output.write_frame(simulator_, runner.next_frame());
  output.flush();
  EXPECT_EQ(summary()["outcome"], "running");
  output.finish("interrupted");
  const nlohmann::json json = summary();
  EXPECT_EQ(json["outcome"], "interrupted");
  EXPECT_EQ(json["frames"], 3);
  EXPECT_EQ(json["frames_written"], 2);
  EXPECT_EQ(json["steps"], 2);
  EXPECT_EQ(json["step"], 0.01);
  EXPECT_EQ(json["substeps"], 2);
  EXPECT_EQ(json["smallest_step"], 0.01);
  EXPECT_EQ(json["threads"], 3);
  EXPECT_EQ(json["scene"]["duration"], 0.1);
  EXPECT_GE(json["wall_seconds"], 0.0);
}

/// A cloth of 8 x 8 particles that hangs far above a ball, by passes that cannot hold it.
Simulator hanging_cloth() {
  BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {8, 8}}, {SpringMaterial{}, {}, {}});
  set_total_mass(shape, 0.2);
  NetworkBuilder builder;
  builder.add_body("cloth", shape);
  builder.pin({56, 63});
  const StretchLimitSettings limit{.iterations = 1, .solver = StretchLimitSettings::Solver::automatic};
  return Simulator(builder.build(), {.step = 0.01, .steps_per_frame = 4, .stretch_limit = limit},
                   {still("ball", SphereGeometry{.radius = 1.0}, {0.0, -9.0, 0.0})});
}

TEST_F(RunOutputFiles, SummaryReportsTheHandoverToNewton) {
  simulator_ = hanging_cloth();
  RunOutput output(OutputFolder(scratch_ / "out", false),
                   {.frames = 9, .steps_per_frame = 4, .stretch_solver = simulator_.stretch_solver()}, simulator_);
  FrameRunner runner(simulator_);
  output.write_frame(simulator_, runner.first_frame());
  output.flush();
  EXPECT_EQ(summary()["stretch_solver"], "gauss_seidel, then newton for what keeps missing the limit");
  EXPECT_THAT(summary()["newton_from"], IsEmpty());
  std::int64_t solves = 0;
  for (int frame = 2; frame <= 9; ++frame) {
    const FrameDiagnostics next = runner.next_frame();
    output.write_frame(simulator_, next);
    output.flush();
    if (solves == 0 && next.limit_solves > 0) {
      EXPECT_EQ(summary()["newton_from"],
                nlohmann::json::parse(R"([{"body": "cloth", "step": )" +
                                      std::to_string(*simulator_.state().limit.handovers[0].solved_since) + R"(, "frame": )" +
                                      std::to_string(frame) + "}]"));
    }
    solves += next.limit_solves;
  }
  EXPECT_GT(solves, 0);
  EXPECT_EQ(summary()["newton_from"].size(), 1U);
}

TEST_F(RunOutputFiles, ThatFitNoMoreTakeTheirWholeFrameBack) {
  RunOutput output = open(3);
  FrameRunner runner(simulator_);
  output.write_frame(simulator_, runner.first_frame());
  output.flush();
  const std::vector<std::string> before = listing(scratch_ / "out");
  const std::string rows = read_text(file("diagnostics.csv"));
  const FrameDiagnostics next = runner.next_frame();
  {
    // The rope (the first body) still fits, the cloth does not.
    const FileSizeLimit limit(std::filesystem::file_size(file("rope/rope.0001.obj")) + 100);
    output.write_frame(simulator_, next);
    EXPECT_THROW(output.flush(), FileError);
  }
  EXPECT_EQ(listing(scratch_ / "out"), before);
  EXPECT_EQ(read_text(file("diagnostics.csv")), rows);
  output.finish("no space");
  EXPECT_EQ(summary()["frames_written"], 1);
}

TEST_F(RunOutputFiles, FrameWhoseRowFitsNoMoreIsTakenBack) {
  RunOutput output = open(3);
  FrameRunner runner(simulator_);
  output.write_frame(simulator_, runner.first_frame());
  output.flush();
  const std::vector<std::string> before = listing(scratch_ / "out");
  const std::uintmax_t room = std::filesystem::file_size(file("diagnostics.csv"));
  const std::string record = read_text(file("record.bin"));
  std::filesystem::resize_file(file("diagnostics.csv"), 100'000);
  {
    const FileSizeLimit limit(100'010);
    output.write_frame(simulator_, runner.next_frame());
    EXPECT_THROW(output.flush(), FileError);
  }
  EXPECT_EQ(std::filesystem::file_size(file("diagnostics.csv")), 100'000U);
  EXPECT_EQ(listing(scratch_ / "out"), before);
  EXPECT_EQ(read_text(file("record.bin")), record);
  std::filesystem::resize_file(file("diagnostics.csv"), room);
  output.write_frame(simulator_, runner.next_frame());
  output.flush();
  EXPECT_EQ(summary()["frames_written"], 2);
}

/// A particle that hangs at a pin, with a record of its force.
Simulator hanging_particle() {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 0.5);
  builder.add_pin({.particles = {0}, .motion = {}, .name = "hook"});
  return Simulator(builder.build(), {.step = 0.01, .steps_per_frame = 2, .gravity = {0.0, -8.0, 0.0}, .record_forces = true});
}

TEST_F(RunOutputFiles, ForcesAreWrittenOnRequestAndReplacedWithTheRun) {
  simulator_ = hanging_particle();
  run(3);
  // 0.5 kg at 8 m/s^2; the steps of 0.01 s are summed, not the time.
  EXPECT_EQ(read_text(file("forces.csv")),
            "frame,time,name,force_x,force_y,force_z\n1,0,hook,0,0,0\n2,0.02,hook,0,4,0\n3,0.04,hook,0,4,0\n");
  EXPECT_THAT(summary()["files"].get<std::vector<std::string>>(), Contains("forces.csv"));
  simulator_ = small_world();
  const RunOutput output(OutputFolder(scratch_ / "out", true), {.frames = 1}, simulator_);
  EXPECT_THAT(listing(scratch_ / "out"), Not(Contains("forces.csv")));
  EXPECT_THAT(summary()["files"].get<std::vector<std::string>>(), Not(Contains("forces.csv")));
}

TEST_F(RunOutputFiles, ForcesOfAFrameWhoseRowFitsNoMoreAreTakenBack) {
  simulator_ = hanging_particle();
  RunOutput output = open(3);
  FrameRunner runner(simulator_);
  output.write_frame(simulator_, runner.first_frame());
  output.flush();
  const std::string forces = read_text(file("forces.csv"));
  std::filesystem::resize_file(file("diagnostics.csv"), 100'000);
  {
    const FileSizeLimit limit(100'010);
    output.write_frame(simulator_, runner.next_frame());
    EXPECT_THROW(output.flush(), FileError);
  }
  EXPECT_EQ(read_text(file("forces.csv")), forces);
}

TEST_F(RunOutputFiles, AreNotRemovedIfAFolderStandsInThePlaceOfOne) {
  run(2);
  std::filesystem::remove(file("record.bin"));
  std::filesystem::create_directory(file("record.bin"));
  const std::vector<std::string> before = listing(scratch_ / "out");
  EXPECT_THROW(OutputFolder(scratch_ / "out", true), FileError);
  EXPECT_EQ(listing(scratch_ / "out"), before);
}

TEST_F(RunOutputFiles, RunWithTheSameNamesReplacesThemWhenAsked) {
  run(3);
  std::ofstream(file(kAnimationFile)) << "the exported run";
  simulator_ = small_world();
  {
    RunOutput output(OutputFolder(scratch_ / "out", true), {.frames = 1}, simulator_);
    output.write_frame(simulator_, FrameRunner(simulator_).first_frame());
    output.flush();
  }
  EXPECT_THAT(listing(scratch_ / "out"), Not(Contains("rope/rope.0002.obj")));
  EXPECT_THAT(listing(scratch_ / "out"), Not(Contains(kAnimationFile)));
  EXPECT_THAT(listing(scratch_ / "out"), Contains("rope/rope.0001.obj"));
}

TEST(RunOutput, NamesThatCannotBeFoldersAreAllReported) {
  NetworkBuilder builder;
  double x = 0.0;
  for (const char* name : {"../up", "obstacles"}) {
    builder.begin_body(name);
    builder.add_particle(Vector3(x++, 0.0, 0.0), 1.0);
  }
  const Obstacle ball = still("ball", SphereGeometry{0.2}, {0.0, 3.0, 0.0});
  const Simulator simulator(builder.build(), {}, {ball, ball});
  const ScratchFolder scratch;
  try {
    const RunOutput output(OutputFolder(scratch.path(), false), {}, simulator);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 3U);
    EXPECT_THAT(error.what(), HasSubstr("../up"));
  }
  EXPECT_THAT(listing(scratch.path()), IsEmpty());
}

TEST_F(RunOutputFiles, AFullDiskKeepsTheFormerCheckpoint) {
  RunOutput output(OutputFolder(scratch_ / "out", false), {.frames = 3, .steps_per_frame = 2, .checkpoint_interval = 1e-9},
                   simulator_);
  FrameRunner runner(simulator_);
  output.write_frame(simulator_, runner.first_frame());
  EXPECT_EQ(output.write_due_checkpoint(simulator_, "memory"), "");
  const std::string former = read_text(file("checkpoint.bin"));
  output.write_frame(simulator_, runner.next_frame());
  output.flush();
  std::string failure;
  {
    const FileSizeLimit full(100);
    failure = output.write_checkpoint_now(simulator_, "memory");
  }
  EXPECT_THAT(failure, ::testing::HasSubstr("checkpoint.bin"));
  EXPECT_EQ(read_text(file("checkpoint.bin")), former);
  EXPECT_THAT(listing(scratch_ / "out"), ::testing::Not(::testing::Contains(".checkpoint.bin.tmp")));
  EXPECT_EQ(output.write_checkpoint_now(simulator_, "memory"), "");
  EXPECT_NE(read_text(file("checkpoint.bin")), former) << "it has the last state now";
}

TEST_F(RunOutputFiles, CheckpointsGiveBackWhatTheCallerRemembers) {
  {
    RunOutput output(OutputFolder(scratch_ / "out", false), {.frames = 9, .steps_per_frame = 2, .checkpoint_interval = 1e-9},
                     simulator_);
    output.write_frame(simulator_, FrameRunner(simulator_).first_frame());
    EXPECT_EQ(output.write_due_checkpoint(simulator_, "memory"), "");
  }
  std::string memory;
  const RunOutput resumed(OutputFolder::as_it_is(scratch_ / "out"), {.frames = 9, .steps_per_frame = 2}, simulator_,
                          read_checkpoint(file("checkpoint.bin")), memory);
  EXPECT_EQ(memory, "memory");
  EXPECT_EQ(resumed.frames_written(), 1);
}

}  // namespace
}  // namespace sprung
