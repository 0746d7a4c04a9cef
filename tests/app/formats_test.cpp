// Formats and plots, as users ask for them. tests/formats judges what the files hold.
#include "app/command_line_fixture.h"

#include <gmock/gmock.h>

namespace sprung {
namespace {

using ::testing::AllOf;
using testing::CommandLine;
using testing::Ending;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using testing::listing;
using ::testing::Not;
using testing::Program;
using testing::read_text;
using testing::rope_scene;
using testing::write_text;

TEST_F(CommandLine, ARunWritesTheFormatsThatAreAskedFor) {
  const Ending ending = run({"run", save(rope_scene()), "--out", out(), "--frames", "3", "--format", "ply,npz,usda"});
  ASSERT_EQ(ending.code, 0) << ending.err;
  EXPECT_THAT(listing(out()), AllOf(IsSupersetOf({"rope/rope.0003.ply", "animation.npz", "animation.usda", "record.bin"}),
                                    Not(::testing::Contains("rope/rope.0001.obj"))));
  // Another run removes them.
  ASSERT_EQ(run({"run", save(rope_scene()), "--out", out(), "--frames", "1", "--format", "none", "--overwrite"}).code, 0);
  EXPECT_THAT(listing(out()), Not(::testing::Contains("animation.npz")));
}

TEST_F(CommandLine, AResumedRunHasAllFramesInEveryFormat) {
  const std::string file = save(rope_scene());
  const std::vector<std::string> all{"--format", "obj,ply,vtk,pc2,npz,gltf"};
  const auto run_into = [&](const std::string& folder, const std::vector<std::string>& words) {
    std::vector<std::string> command{"run", file, "--out", out(folder)};
    command.insert(command.end(), all.begin(), all.end());
    command.insert(command.end(), words.begin(), words.end());
    return run(command);
  };
  ASSERT_EQ(run_into("whole", {"--frames", "6"}).code, 0);
  ASSERT_EQ(run_into("parts", {"--frames", "3"}).code, 0);
  const Ending ending = run_into("parts", {"--frames", "6", "--resume"});
  ASSERT_EQ(ending.code, 0) << ending.err;
  EXPECT_EQ(listing(out("whole")), listing(out("parts")));
  for (const char* name : {"animation.npz", "animation.glb", "rope.pc2", "rope.pvd", "rope/rope.0006.ply", "rope/rope.0002.vtp"}) {
    EXPECT_EQ(read_text(out("whole") + "/" + name), read_text(out("parts") + "/" + name)) << name;
  }
}

TEST_F(CommandLine, AnExportReplacesExportsAloneAndOnlyIfAsked) {
  ASSERT_EQ(run({"run", save(rope_scene()), "--out", out(), "--frames", "2", "--format", "obj"}).code, 0);
  const std::string frame = read_text(out() + "/rope/rope.0001.obj");
  const std::vector<std::string> once{"export", out(), "--format", "npz,ply"};
  EXPECT_EQ(run(once).code, 0);
  EXPECT_THAT(run(once).err, AllOf(HasSubstr("it exists"), HasSubstr("--overwrite")));
  std::vector<std::string> again = once;
  again.emplace_back("--overwrite");
  EXPECT_EQ(run(again).code, 0);
  EXPECT_THAT(run({"export", out(), "--format", "obj", "--overwrite"}).err, HasSubstr("it is a file of the run"));
  EXPECT_EQ(read_text(out() + "/rope/rope.0001.obj"), frame);
  EXPECT_EQ(run({"export", out(), "--format", "obj,gltf", "--out", out("elsewhere")}).code, 0);
  EXPECT_EQ(read_text(out("elsewhere") + "/rope/rope.0001.obj"), frame);
}

TEST_F(CommandLine, ARunThatGoesOnRemembersItsExports) {
  const std::string file = save(rope_scene());
  ASSERT_EQ(run({"run", file, "--out", out(), "--frames", "2", "--format", "none"}).code, 0);
  ASSERT_EQ(run({"export", out(), "--format", "gltf,pc2"}).code, 0);
  ASSERT_EQ(run({"run", file, "--out", out(), "--frames", "4", "--format", "none", "--resume"}).code, 0);
  EXPECT_EQ(run({"export", out(), "--format", "gltf", "--overwrite"}).code, 0);
  EXPECT_EQ(run({"run", file, "--out", out(), "--frames", "2", "--format", "pc2", "--overwrite"}).code, 0);
  EXPECT_THAT(listing(out()), AllOf(IsSupersetOf({"rope.pc2", "rope.obj"}), Not(::testing::Contains("animation.glb"))));
}

TEST_F(CommandLine, AnExportLeavesNoFramesOfALongerOne) {
  const std::string file = save(rope_scene());
  ASSERT_EQ(run({"run", file, "--out", out(), "--frames", "4", "--format", "none"}).code, 0);
  ASSERT_EQ(run({"run", file, "--out", out("short"), "--frames", "2", "--format", "none"}).code, 0);
  ASSERT_EQ(run({"export", out(), "--format", "ply", "--out", out("files")}).code, 0);
  ASSERT_EQ(run({"export", out("short"), "--format", "ply", "--out", out("files"), "--overwrite"}).code, 0);
  EXPECT_THAT(listing(out("files")),
              AllOf(::testing::Contains("rope/rope.0002.ply"), Not(::testing::Contains("rope/rope.0003.ply"))));
}

// record.bin can be removed: then the OBJ frames are read, and not the first frame that lies beside a point cache.
TEST_F(CommandLine, ARunWithoutItsRecordIsReadFromItsFrames) {
  ASSERT_EQ(run({"run", save(rope_scene()), "--out", out(), "--frames", "2", "--format", "obj,pc2"}).code, 0);
  std::filesystem::remove(out() + "/record.bin");
  EXPECT_EQ(run({"export", out(), "--format", "npz", "--out", out("elsewhere")}).code, 0);
}

TEST_F(CommandLine, FormatsThatNeedTheRecordAreRefusedWithoutIt) {
  const Ending ending = run({"run", save(rope_scene()), "--out", out(), "--format", "obj,npz", "--set", "output.record=false"});
  EXPECT_EQ(ending.code, 2);
  EXPECT_THAT(ending.err, AllOf(HasSubstr("npz"), HasSubstr("record")));
  EXPECT_FALSE(wrote_something());
  EXPECT_EQ(
      run({"run", save(rope_scene()), "--out", out(), "--frames", "2", "--format", "ply", "--set", "output.record=false"}).code, 0);
  EXPECT_EQ(run({"run", save(rope_scene()), "--out", out("two"), "--format", "none,obj"}).code, 2);
  EXPECT_EQ(run({"run", save(rope_scene()), "--out", out("two"), "--format", "npz,npz64"}).code, 2);
}

TEST_F(CommandLine, PlotDrawsOneRunOrSeveral) {
  ASSERT_EQ(run({"run", save(rope_scene()), "--out", out(), "--frames", "3", "--format", "none"}).code, 0);
  ASSERT_EQ(
      run({"run", save(rope_scene()), "--out", out("other"), "--frames", "4", "--format", "none", "--set", "output.record=false"})
          .code,
      0);
  const Ending one = run({"plot", out(), "--out", out("one.svg")});
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(read_text(out("one.svg")), AllOf(HasSubstr("kinetic"), HasSubstr("stretch of springs"), HasSubstr("computing time")));
  ASSERT_EQ(run({"plot", out(), out("other"), "--out", out("two.svg")}).code, 0);
  EXPECT_THAT(read_text(out("two.svg")), AllOf(HasSubstr(out("other")), Not(HasSubstr("kinetic"))));
  ASSERT_EQ(run({"plot", out()}).code, 0);
  EXPECT_THAT(read_text(out() + "/diagnostics.png"), HasSubstr("PNG"));
  EXPECT_THAT(run({"plot", out()}).err, HasSubstr("--overwrite"));
  EXPECT_EQ(run({"run", save(rope_scene()), "--out", out(), "--frames", "1", "--overwrite"}).code, 0);
  EXPECT_THAT(listing(out()), Not(::testing::Contains("diagnostics.png")));
}

TEST_F(CommandLine, PlotSaysWhatItNeeds) {
  ASSERT_EQ(run({"run", save(rope_scene()), "--out", out(), "--frames", "2", "--format", "none"}).code, 0);
  const Ending ending = run({"plot", out(), "--out", out("a.gif")});
  EXPECT_EQ(ending.code, 2);
  EXPECT_THAT(ending.err, HasSubstr(".png or .svg"));
  const Ending without = Program({"plot", out()}, {.environment = {{"PATH", out("nowhere")}}}).wait();
  EXPECT_EQ(without.code, 5);
  EXPECT_THAT(without.err, HasSubstr("gnuplot-nox"));
  EXPECT_EQ(run({"plot", out("nothing")}).code, 5);
}

}  // namespace
}  // namespace sprung
