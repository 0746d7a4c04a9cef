// What all formats have in common, and what each of them says of its losses. tests/formats reads the files back.
#include "output/exporters/exporter.h"

#include "base/files/file_pattern.h"
#include "base/scratch_folder.h"
#include "geometry/import/mesh_import.h"
#include "output/recorded_samples.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>

namespace sprung {
namespace {

using testing::frame_of;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::model_with_one_of_each;
using testing::ScratchFolder;
using testing::write_text;

constexpr int kFrames = 3;

ExportedRun sample(int frames = kFrames) { return {.model = model_with_one_of_each(), .frame_rate = 3.0, .frames = frames}; }

/// The frames of the sample, without the second face of its quad from frame 2 on.
ExportedFrame sample_frame(int number) {
  std::srand(static_cast<unsigned>(number));  // of Eigen's random points
  ExportedFrame frame{.number = number, .state = frame_of(model_with_one_of_each(), number)};
  frame.torn.resize(2);
  if (number > 1) frame.torn[0] = {1};
  return frame;
}

/// All files of an export, by their names.
std::map<std::string, std::string> exported(const std::string& format) {
  const std::unique_ptr<Exporter> exporter = make_exporter(format, sample());
  std::map<std::string, std::string> files;
  const auto keep = [&](const ExportedFile& file) { files[file.path] = file.bytes; };
  for (int number = 1; number <= kFrames; ++number) std::ranges::for_each(exporter->frame(sample_frame(number)), keep);
  std::ranges::for_each(exporter->end(kFrames), keep);
  return files;
}

class Formats : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, Formats, ::testing::ValuesIn(exporter_formats()), [](const auto& name) { return name.param; });

bool is_listed(const std::string& path, const Exporter& exporter) {
  return std::ranges::any_of(exporter.patterns(), [&](const std::string& pattern) {
    for (int number = 1; number <= kFrames; ++number) {
      if (fill_pattern(pattern, number) == path) return true;
    }
    return false;
  });
}

TEST_P(Formats, WriteTheFilesThatTheyListAndNoOthers) {
  const std::unique_ptr<Exporter> exporter = make_exporter(GetParam(), sample());
  const auto files = exported(GetParam());
  for (const auto& [path, bytes] : files) EXPECT_TRUE(is_listed(path, *exporter)) << path;
  for (const std::string& pattern : exporter->patterns()) {
    EXPECT_TRUE(stays_inside(pattern));
    EXPECT_TRUE(files.contains(fill_pattern(pattern, 1))) << pattern;
  }
}

TEST_P(Formats, GiveTheSameBytesForTheSameFrames) { EXPECT_EQ(exported(GetParam()), exported(GetParam())); }

// A run that is resumed makes a new exporter, which then sees the later frames alone.
TEST_P(Formats, OfAFileAFrameNeedNoFormerFrames) {
  const std::unique_ptr<Exporter> exporter = make_exporter(GetParam(), sample());
  if (!exporter->writes_each_frame()) return;
  const auto whole = exported(GetParam());
  for (const ExportedFile& file : exporter->frame(sample_frame(kFrames))) EXPECT_EQ(file.bytes, whole.at(file.path)) << file.path;
  for (const ExportedFile& file : exporter->end(kFrames)) EXPECT_EQ(file.bytes, whole.at(file.path)) << file.path;
}

TEST_P(Formats, OfARunWithoutBodiesAndObstaclesDoNotFail) {
  const std::unique_ptr<Exporter> exporter = make_exporter(GetParam(), {});
  EXPECT_NO_THROW((void)exporter->frame({}));
  EXPECT_NO_THROW((void)exporter->end(1));
}

// assimp reads these. The quad's last two vertices are one particle, so its second triangle has no area.
TEST(ExportedMesh, IsReadByAssimp) {
  const ScratchFolder folder;
  for (const std::string path : {"obstacles/floor.ply", "obstacles/floor.obj"}) {
    const auto files = exported(path.substr(path.size() - 3));
    const std::filesystem::path file = folder.path() / std::filesystem::path(path).filename();
    write_text(file, files.at(path));
    EXPECT_EQ(import_mesh(file).mesh.triangles.cols(), 1) << path;
  }
  const std::filesystem::path glb = folder.path() / "animation.glb";
  write_text(glb, exported("gltf").at("animation.glb"));
  EXPECT_GE(import_mesh(glb).mesh.triangles.cols(), 3);
}

TEST(Exporter, LeavesOutTornFacesWhereAFrameHasFacesOfItsOwn) {
  const auto ply = exported("ply");
  EXPECT_THAT(ply.at("quad/quad.0001.ply"), HasSubstr("element face 2"));
  EXPECT_THAT(ply.at("quad/quad.0002.ply"), HasSubstr("element face 1"));
  EXPECT_THAT(exported("vtk").at("quad/quad.0002.vtp"), HasSubstr("NumberOfPolys=\"1\""));
  const std::string usd = exported("usda").at("animation.usda");
  EXPECT_THAT(usd, AllOf(HasSubstr("1: [3, 3]"), HasSubstr("2: [3]"), Not(HasSubstr("3: [3]"))));
}

// A run has the textures, and its record has their names.
TEST(Exporter, OfObjWritesBodiesAsTheirFiles) {
  const auto obj = exported("obj");
  EXPECT_THAT(obj.at("quad/quad.0001.obj"),
              AllOf(HasSubstr("mtllib look/a.mtl"), HasSubstr(" red\nvn "), HasSubstr("usemtl blue\nf")));
  EXPECT_THAT(obj.at("quad/quad.0002.obj"), AllOf(HasSubstr("usemtl red paint\nf 1/1/1"), Not(HasSubstr("usemtl blue\nf"))));
  EXPECT_EQ(obj.at("quad/look/a.mtl"), "newmtl blue\n");
  EXPECT_FALSE(obj.contains("quad/look/red.png"));
  EXPECT_THAT(make_exporter("obj", sample())->losses(false), ::testing::ElementsAre(HasSubstr("quad/look/red.png")));
}

TEST(Exporter, SaysWhatAFormatCannotHold) {
  const auto losses = [](const std::string& format, bool tears) { return make_exporter(format, sample())->losses(tears); };
  EXPECT_THAT(losses("ply", true), ::testing::ElementsAre(HasSubstr("no materials")));
  EXPECT_THAT(losses("pc2", true), ::testing::Contains(HasSubstr("tear")));
  EXPECT_THAT(losses("gltf", false), ::testing::ElementsAre(HasSubstr("no groups"), HasSubstr("no textures")));
  EXPECT_THAT(losses("usda", true), ::testing::ElementsAre(HasSubstr("without colours")));
  EXPECT_THAT(losses("vtk", true), ::testing::ElementsAre(HasSubstr("of quad have no springs"), HasSubstr("no UVs")));
  EXPECT_THAT(make_exporter("gltf", sample(600))->losses(false), ::testing::Contains(HasSubstr("every 3. frame of quad")));
  for (const std::string& format : exporter_formats()) EXPECT_THAT(make_exporter(format, {})->losses(false), IsEmpty()) << format;
}

// 300 frames: every second one, and the last.
TEST(Exporter, OfGltfEndsWithTheLastFrame) {
  ExportedRun run = sample(300);
  run.model.obstacles.clear();  // whose poses have keys at all times
  const std::unique_ptr<Exporter> exporter = make_exporter("gltf", run);
  ExportedFrame frame = sample_frame(1);
  for (int number = 1; number <= run.frames; ++number) {
    frame.number = number;
    frame.state.time = (number - 1) / run.frame_rate;
    (void)exporter->frame(frame);
  }
  const std::string glb = exporter->end(run.frames).front().bytes;
  EXPECT_THAT(glb, HasSubstr("\"max\":[" + std::to_string(299.0 / 3.0).substr(0, 6)));
}

TEST(Exporter, GivesUsdPrimsNamesOfTheirOwn) {
  ExportedRun run = sample();
  run.model.bodies[0].name = "a-b";
  run.model.bodies[1].name = "a_b";
  const std::unique_ptr<Exporter> exporter = make_exporter("usda", run);
  (void)exporter->frame(sample_frame(1));
  const std::string usd = exporter->end(1).front().bytes;
  EXPECT_THAT(usd, AllOf(HasSubstr("def Mesh \"a_b\""), HasSubstr("def BasisCurves \"a_b_\"")));
}

TEST(Exporter, OfAnUnknownFormatIsNone) { EXPECT_EQ(make_exporter("fbx", sample()), nullptr); }

}  // namespace
}  // namespace sprung
