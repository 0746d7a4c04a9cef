// Bodies that are read from OBJ files: what a run writes of them.
#include "app/command_line_fixture.h"
#include "geometry/mesh/polygon_mesh.h"
#include "output/recorded_run.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <sstream>

namespace sprung::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

struct NamedMesh {
  const char* name;
  std::string text;
};

void PrintTo(const NamedMesh& mesh, std::ostream* out) { *out << mesh.name; }

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::string with_carriage_returns(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return result;
}

std::vector<NamedMesh> ten_meshes() {
  const std::string groups = "# made by hand\nmtllib a.mtl b.mtl\no shirt\n" + kSquare +
                             "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\ng front collar\nusemtl red\ns 1\nf 1/1/1 2/2/1 3/3/1\n"
                             "g\nusemtl\ns off\nf 1/1/1 3/3/1 4/4/1\n";
  return {
      {"groups_materials_and_normals", groups},
      {"carriage_returns", with_carriage_returns(groups)},
      {"seam_of_UVs", kSquare + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\nf 1/1 2/2 3/3\nf 1/5 3/2 4/4\n"},
      {"polygons", "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nv 1 3 0\nf 1 2 3 4 5\nf 5 4 6\n"},
      {"negative_numbers", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf -3/-1 -2/-1 -1/-1\nv 1 1 0\nf -3 -1 -2\n"},
      {"lines_and_points", kSquare + "v 0 -1 0\nv 0 -2 0\nf 1 2 3 4\nl 1 5 6\nl 3 1\np 1 2\n"},
      {"colours_and_weights", "v 0 0 0 1 0.5 0.25\nv 1 0 0 1 0 0\nv 1 1 0 1.0\nf 1 2 3\n"},
      {"odd_blanks_and_comments",
       "  v\t0 0   0 # corner\n\n\nv 1 0 0\\\n 1\n#v 9 9 9\nv +1 1e0 0\nf 1 \\\n2 3  # end \\\nvp 0.5\nshadow_obj x.obj"},
      {"several_libraries_and_objects",
       "mtllib a.mtl\nmtllib \"c d.mtl\"\no one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\no two\n"
       "v 0 0 1\nv 1 0 1\nv 0 1 1\ns 2\nusemtl n\nf 4 5 6\nl 1 4\n"},
      {"rope_of_lines", "v 0 0 0\nv 1 0 0\nv 2 0 0\ng rope\nl 1 2 3\ng\n"},
  };
}

/// The text without the numbers of `v` lines, and these numbers.
std::pair<std::string, std::vector<double>> split_positions(const std::string& text) {
  std::string rest;
  std::vector<double> numbers;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string::npos || line[begin] != 'v' || (line[begin + 1] != ' ' && line[begin + 1] != '\t')) {
      rest += line + '\n';
      continue;
    }
    const char* at = line.c_str() + begin + 1;
    for (int axis = 0; axis < 3; ++axis) {
      char* end = nullptr;
      numbers.push_back(std::strtod(at, &end));
      at = end;
    }
    rest += line.substr(0, begin + 1) + at + '\n';
  }
  return {rest, numbers};
}

/// A body of the file `mesh.obj` that falls for two frames.
json mesh_scene() {
  return json::parse(R"({
    "duration": 0.04,
    "bodies": {
      "shirt": {
        "shape": { "type": "mesh", "file": "mesh.obj" },
        "mass": 0.1,
        "springs": { "structural": { "stiffness": 10 } },
        "place": { "position": [0, 3, 0] }
      }
    }
  })");
}

class MeshBodyFiles : public CommandLine {
 protected:
  Ending run_mesh(const std::string& mesh, const json& scene = mesh_scene(), const std::vector<std::string>& more = {}) const {
    write_text(scratch_ / "mesh.obj", mesh);
    std::vector<std::string> arguments{"run", save(scene), "--out", out()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] std::string frame(int number) const {
    return read_text(scratch_ / ("out/shirt/shirt.000" + std::to_string(number) + ".obj"));
  }
};

class TenMeshes : public MeshBodyFiles, public ::testing::WithParamInterface<NamedMesh> {};

TEST_P(TenMeshes, ComeOutAsTheyWentInButForPositions) {
  ASSERT_EQ(run_mesh(GetParam().text).code, 0);
  const auto [rest, numbers] = split_positions(GetParam().text);
  const RecordedRun recorded(scratch_ / "out");
  for (int number = 1; number <= 2; ++number) {
    const auto [rest_of_frame, positions] = split_positions(frame(number));
    EXPECT_EQ(rest_of_frame, rest);
    EXPECT_EQ(frame(number).back(), GetParam().text.back());
    ASSERT_EQ(positions.size(), numbers.size());
    // What the body does: it is 3 m higher, and then it falls. Sums like 1 + 3 are exact.
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const double placed = numbers[i] + (i % 3 == 1 ? 3.0 : 0.0);
      if (number == 1) {
        EXPECT_EQ(positions[i], placed);
      } else if (i % 3 == 1) {
        EXPECT_LT(positions[i], placed);
      }
    }
    const Points read_again = vertices_of(recorded.model().bodies.at(0), recorded.frame(number));
    EXPECT_EQ(std::vector<double>(read_again.data(), read_again.data() + read_again.size()), positions);
  }
}

INSTANTIATE_TEST_SUITE_P(MeshBodyFiles, TenMeshes, ::testing::ValuesIn(ten_meshes()),
                         [](const auto& mesh) { return mesh.param.name; });

TEST_F(MeshBodyFiles, NormalsAreWrittenAnewOnRequest) {
  json scene = mesh_scene();
  scene["bodies"]["shirt"]["normals"] = true;
  scene["bodies"]["shirt"]["place"]["rotation"] = {0, 90, 0};
  // Two triangles at a right angle; the first vertex has 90 degrees in each of them, and the last one is in no face.
  const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 9 9 9\nf 1/1/1 2 3//1\nv 0 0 1\nf -4/-1/-1 -1 -3\nv 5 5 5";
  const Ending ending = run_mesh(mesh, scene);
  ASSERT_EQ(ending.code, 0);
  EXPECT_THAT(ending.err, Not(HasSubstr("vn")));
  std::vector<Vector3> normals;
  std::vector<std::string> others;
  std::istringstream stream(frame(1));
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string kind;
    Vector3 normal;
    words >> kind >> normal[0] >> normal[1] >> normal[2];
    if (kind == "vn") normals.push_back(normal);
    if (kind != "vn" && kind != "v") others.push_back(line);
  }
  EXPECT_THAT(others, ElementsAre("vt 0 0", "f 1/1/1 2//2 3//3", "f -4/-1/-4 -1//-1 -3//-3"));
  ASSERT_EQ(normals.size(), 5U);
  // In the file the faces' normals are (0, 0, 1) and (0, 1, 0); a turn by 90 degrees about y takes z to x. The second vertex has 45
  // degrees in each face. A rotation and a normalisation round a few times: some 1e-16.
  const double half = std::sqrt(0.5);
  const std::vector<Vector3> expected{{half, half, 0}, {half, half, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}};
  for (std::size_t i = 0; i < normals.size(); ++i) EXPECT_LT((normals[i] - expected[i]).norm(), 1e-15) << i;
}

TEST_F(MeshBodyFiles, StaleNormalsAreToldOnce) {
  const Ending ending = run_mesh(kSquare + "vn 0 0 1\nvn 0 1 0\nf 1//1 2//1 3//1 4//2\n");
  EXPECT_EQ(ending.code, 0);
  EXPECT_THAT(ending.err, HasSubstr("\"normals\": true"));
  EXPECT_EQ(summary()["warnings"].size(), 1U);
}

// Two squares that share an edge, each with vertices of its own there, as a seam of a garment.
const std::string kSeam = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0.0000001\nf 1 2 3 4\nf 5 6 7 8\n";

TEST_F(MeshBodyFiles, WeldStitchesASeamAndKeepsTheFile) {
  json scene = mesh_scene();
  scene["bodies"]["shirt"]["shape"]["weld"] = 1e-6;
  scene["bodies"]["shirt"]["self_contact"] = true;
  scene["bodies"]["shirt"]["thickness"] = 0.01;
  scene["bodies"]["shirt"]["pins"] = json::parse(R"([ { "indices": [0, 3, 7] } ])");
  ASSERT_EQ(run_mesh(kSeam, scene).code, 0);
  EXPECT_EQ(split_positions(frame(2)).first, split_positions(kSeam).first);
  const RecordedRun recorded(scratch_ / "out");
  const Points first = vertices_of(recorded.model().bodies.at(0), recorded.frame(1));
  const Points second = vertices_of(recorded.model().bodies.at(0), recorded.frame(2));
  ASSERT_EQ(second.cols(), 8);
  EXPECT_EQ(second.col(1), second.col(4));
  EXPECT_EQ(second.col(2), second.col(7));
  EXPECT_EQ(second.col(7), first.col(7)) << "index 7 is the eighth vertex of the file";
  EXPECT_LT(second(1, 6), first(1, 6));
  EXPECT_EQ(run({"validate", save(scene)}).code, 0);
  EXPECT_THAT(run({"validate", save(scene)}).out, HasSubstr("6 particles (3 pinned)"));
}

TEST_F(MeshBodyFiles, ASeamThatStopsTheStartIsToldWithTheWeld) {
  json scene = mesh_scene();
  scene["bodies"]["shirt"]["self_contact"] = true;
  const Ending ending = run_mesh(kSeam, scene);
  EXPECT_EQ(ending.code, 3);
  EXPECT_THAT(ending.err, HasSubstr("\"weld\": 1e-6"));
}

TEST_F(MeshBodyFiles, PiecesAreCountedWithTheWeldThatJoinsThem) {
  std::string soup;
  for (int i = 0; i < 100; ++i) {
    const std::string x = std::to_string(i);
    const std::string next = std::to_string(i + 1);
    soup += "v " + x + " 0 0\nv " + next + " 0 0\nv " + x + " 1 0\nf -3 -2 -1\n";
    soup += "v " + next + " 0 0\nv " + next + " 1 0\nv " + x + " 1 0\nf -3 -2 -1\n";
  }
  write_text(scratch_ / "mesh.obj", soup);
  json scene = mesh_scene();
  scene["bodies"]["shirt"]["place"]["scale"] = 0.01;
  const std::string text = run({"validate", save(scene)}).out;
  EXPECT_THAT(text, HasSubstr("200 pieces"));
  EXPECT_THAT(text, HasSubstr("Weld vertices within 1e-6 m with \"weld\": 1e-6"));
  scene["bodies"]["shirt"]["shape"]["weld"] = 1e-6;
  const std::string welded = run({"validate", save(scene)}).out;
  EXPECT_THAT(welded, HasSubstr("202 particles"));
  EXPECT_THAT(welded, Not(HasSubstr("pieces")));
}

TEST_F(MeshBodyFiles, MaterialsAreCopiedBesideTheFramesAndNeverOutside) {
  write_text(scratch_ / "meshes/look/a.mtl",
             "newmtl red\nmap_Kd -s 2 2 tex/red cloth.png\nmap_Bump ../up.png\nbump -bm 0.5 gone.png\n");
  write_text(scratch_ / "meshes/look/tex/red cloth.png", std::string("red\0png", 7));
  write_text(scratch_ / "meshes/up.png", "up");
  write_text(scratch_ / "b.mtl", "newmtl blue\nmap_Kd " + (scratch_ / "meshes/up.png").string() + "\n");
  write_text(scratch_ / "meshes/mesh.obj", "mtllib look/a.mtl ../b.mtl missing.mtl\n" + kSquare + "f 1 2 3 4\n");
  json scene = mesh_scene();
  scene["bodies"]["shirt"]["shape"]["file"] = "meshes/mesh.obj";
  const Ending ending = run({"run", save(scene), "--out", out()});
  ASSERT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(listing(scratch_ / "out/shirt"), ElementsAre("b.mtl", "look/", "look/a.mtl", "look/tex/", "look/tex/red cloth.png",
                                                           "look/up.png", "shirt.0001.obj", "shirt.0002.obj", "up.png"));
  EXPECT_EQ(read_text(scratch_ / "out/shirt/look/a.mtl"),
            "newmtl red\nmap_Kd -s 2 2 tex/red cloth.png\nmap_Bump up.png\nbump -bm 0.5 gone.png\n");
  EXPECT_EQ(read_text(scratch_ / "out/shirt/b.mtl"), "newmtl blue\nmap_Kd up.png\n");
  EXPECT_EQ(read_text(scratch_ / "out/shirt/look/tex/red cloth.png"), std::string("red\0png", 7));
  EXPECT_EQ(summary()["warnings"].size(), 2U);
  EXPECT_THAT(ending.err, HasSubstr("\"gone.png\" and \"missing.mtl\""));
  EXPECT_THAT(ending.err, HasSubstr("\"../b.mtl\""));
  EXPECT_EQ(RecordedRun(scratch_ / "out").model().bodies.size(), 1U);

  // The record has them too, but for textures.
  const Ending exported = run({"export", out(), "--format", "obj", "--out", out("exported")});
  ASSERT_EQ(exported.code, 0) << exported.err;
  EXPECT_THAT(exported.err,
              AllOf(HasSubstr("shirt/look/tex/red cloth.png"), HasSubstr("shirt/look/up.png"), HasSubstr("shirt/up.png")));
  for (const char* name : {"shirt.0001.obj", "shirt.0002.obj", "look/a.mtl", "b.mtl"}) {
    EXPECT_EQ(read_text(scratch_ / "exported/shirt" / name), read_text(scratch_ / "out/shirt" / name)) << name;
  }

  // What a run wrote goes with it, and nothing else.
  write_text(scratch_ / "out/shirt/look/mine.png", "mine");
  ASSERT_EQ(run({"run", save(rope_scene()), "--out", out(), "--overwrite"}).code, 0);
  EXPECT_THAT(listing(scratch_ / "out/shirt"), ElementsAre("look/", "look/mine.png"));
}

}  // namespace
}  // namespace sprung::testing
