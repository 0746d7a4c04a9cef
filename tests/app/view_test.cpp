// `sprung view` from outside: what it shows, what it refuses, and how it finds a browser.
#include "app/command_line_fixture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace sprung {
namespace {

using ::testing::AllOf;
using testing::CommandLine;
using testing::Ending;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using testing::Program;
using testing::read_text;
using testing::rope_scene;
using testing::write_text;

class View : public CommandLine {
 protected:
  void SetUp() override {
    const Ending ending = run({"view", (scratch_ / "none.json").string()});
    if (is_without_viewer(ending)) GTEST_SKIP() << ending.err;
  }

  /// What `view` prints with a program xdg-open in the PATH; `until` says when to interrupt it.
  template <class Condition>
  Ending interrupted(const std::vector<std::pair<std::string, std::string>>& environment, const Condition& until) {
    Program program({"view", save(rope_scene()), "--port", "0"}, {.environment = environment});
    EXPECT_TRUE(wait_until([&] { return program.out().ends_with("\n") && until(program); }));
    program.send(SIGINT);
    return program.wait();
  }

  /// The environment with a screen and with `script` as xdg-open.
  std::vector<std::pair<std::string, std::string>> with_opener(const std::string& script) {
    const std::filesystem::path file = scratch_ / "programs/xdg-open";
    std::filesystem::create_directories(file.parent_path());
    write_text(file, "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    return {{"PATH", file.parent_path().string()}, {"DISPLAY", ":0"}};
  }
};

constexpr auto kAtOnce = [](const Program&) { return true; };

TEST_F(View, ThatFindsNoSceneAndNoRunEndsWithFive) {
  ASSERT_EQ(run({"run", save(rope_scene()), "--out", out("frames")}).code, 0);
  const Ending scene = run({"view", (scratch_ / "scen.json").string()});
  EXPECT_EQ(scene.code, 5);
  EXPECT_EQ(scene.out, "") << "no address is served";
  EXPECT_THAT(scene.err, AllOf(HasSubstr("scen.json: cannot read: there is no such file"), HasSubstr("scene.json\"?")));
  EXPECT_THAT(run({"view", out("none")}).err, HasSubstr("give a scene file, or the folder of a run"));
  for (const char* name : {"fraems", "fraems/"}) {
    const Ending folder = run({"view", out(name)});
    EXPECT_EQ(folder.code, 5);
    EXPECT_THAT(folder.err, HasSubstr("did you mean \"" + out("frames") + "\"?"));
  }
}

TEST_F(View, OfAFolderWithoutAReadableRunEndsWithFive) {
  std::filesystem::create_directories(out());
  const Ending ending = run({"view", out()});
  EXPECT_EQ(ending.code, 5);
  EXPECT_THAT(ending.err, AllOf(HasSubstr("run.json: cannot read: it is missing"), HasSubstr("give the folder of a run")));
  std::filesystem::create_directories(scratch_ / "out/run.json");
  EXPECT_EQ(run({"view", out()}).code, 5);
  ASSERT_EQ(run({"run", save(rope_scene()), "--out", out("frames")}).code, 0);
  write_text(scratch_ / "frames/run.json", "{}");
  EXPECT_EQ(run({"view", out("frames")}).code, 3) << "read, but invalid";
}

TEST_F(View, ServesASceneWithProblemsAndTellsThem) {
  Program program({"view", save(rope_scene()), "--no-open", "--set", "duration=-1"});
  EXPECT_TRUE(wait_until([&] { return program.out().ends_with("\n") && program.err().ends_with("\n"); }));
  program.send(SIGINT);
  const Ending ending = program.wait();
  EXPECT_EQ(ending.code, 0);
  EXPECT_THAT(ending.err, HasSubstr("duration = -1"));
}

TEST_F(View, OpensALessonByItsNameAndListsThemForAnother) {
  for (const char* name : {"3_damping", "damping", "3"}) {
    Program program({"view", "--lesson", name, "--no-open"});
    EXPECT_TRUE(wait_until([&] { return program.out().ends_with("\n"); })) << name;
    program.send(SIGINT);
    EXPECT_EQ(program.wait().code, 0);
  }
  const Ending ending = run({"view", "--lesson", "dampling"});
  EXPECT_EQ(ending.code, 2);
  EXPECT_THAT(ending.err,
              MatchesRegex(".*no such lesson; choose from 1_mass_on_a_spring, .*3_damping.*, 6_limit_or_stiff_springs\n"));
}

TEST_F(View, NeedsASceneOrALesson) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"view"}, {"view", save(rope_scene()), "--lesson", "3"}}) {
    const Ending ending = run(arguments);
    EXPECT_EQ(ending.code, 2);
    EXPECT_THAT(ending.err, HasSubstr("--lesson NAME"));
  }
}

TEST_F(View, SavesIntoAFolderThatExists) {
  const Ending ending = run({"view", save(rope_scene()), "--save-to", out("none")});
  EXPECT_EQ(ending.code, 2);
  EXPECT_THAT(ending.err, HasSubstr("none"));
}

TEST_F(View, OpensItsAddressInTheBrowser) {
  const std::filesystem::path opened = scratch_ / "opened";
  const auto environment =
      with_opener("echo \"$1\" > '" + opened.string() + ".new'; /bin/mv '" + opened.string() + ".new' '" + opened.string() + "'");
  const Ending ending = interrupted(environment, [&](const Program&) { return std::filesystem::exists(opened); });
  EXPECT_EQ(ending.code, 0);
  EXPECT_THAT(ending.out, MatchesRegex("http://127.0.0.1:[1-9][0-9]*/.token=[0-9a-f]+\n"));
  EXPECT_EQ(read_text(opened), ending.out);
  EXPECT_EQ(ending.err, "");
}

TEST_F(View, WithoutABrowserSaysWhatToDo) {
  const Ending no_program = interrupted({{"PATH", scratch_.path().string()}, {"DISPLAY", ":0"}}, kAtOnce);
  EXPECT_EQ(no_program.code, 0);
  EXPECT_THAT(no_program.err, AllOf(HasSubstr("xdg-open is not installed. Open the address above"), HasSubstr("run ssh -L ")));

  auto environment = with_opener("exit 0");
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "BROWSER"}) environment.emplace_back(name, "");
  EXPECT_THAT(interrupted(environment, kAtOnce).err, HasSubstr("there is no screen"));

  const Ending failed =
      interrupted(with_opener("exit 3"), [](const Program& program) { return program.err().find("HOST") != std::string::npos; });
  EXPECT_THAT(failed.err, HasSubstr("xdg-open failed (exit code 3). Open the address above"));
}

}  // namespace
}  // namespace sprung
