// What a live run keeps of its past: saved runs, states as the start of a scene, and going back.
#include "viewer/live/saving.h"
#include "base/error.h"
#include "output/recorded_run.h"
#include "scene/scene_text.h"
#include "viewer/live/live_session.h"
#include "viewer/rope_scenes.h"
#include "viewer/test_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace sprung {
namespace {

namespace fs = std::filesystem;

using ::testing::HasSubstr;
using testing::Json;
using testing::kDivergingScene;
using testing::kScene;
using testing::Received;
using testing::ServingServer;
using testing::TestPage;

class SavedRun : public ::testing::Test {
 protected:
  std::unique_ptr<LiveRun> run(const char* text = kScene) {
    return std::make_unique<LiveRun>(SceneSource{.file = folder_.write("scene.json", text).string()});
  }
  [[nodiscard]] fs::path saved(const std::string& name = "saved") const { return folder_.path() / name; }

  static void advance(LiveRun& run, int frames) {
    for (int k = 0; k < frames * run.simulator().settings().steps_per_frame; ++k) run.step();
  }

  SceneFolder folder_;
};

TEST_F(SavedRun, HasTheFramesThatWereShownWithWhatTheHandDid) {
  const auto live = run();
  std::vector<Points> shown{live->simulator().positions()};
  for (int frame = 1; frame < 6; ++frame) {
    if (frame == 2) live->grab(10);
    if (frame == 3) live->drag({1.0, 1.0, 0.0});
    if (frame == 4) live->drop(true);
    advance(*live, 1);
    shown.push_back(live->simulator().positions());
  }
  live->save(saved());
  const RecordedRun recorded(saved());
  ASSERT_EQ(recorded.frames(), 6);
  for (int frame = 0; frame < 6; ++frame) EXPECT_EQ(recorded.frame(frame + 1).positions, shown[static_cast<std::size_t>(frame)]);
  EXPECT_EQ(recorded.frame(4).states[10] & kPinned, 0);
  EXPECT_EQ(recorded.frame(6).states[10] & kPinned, kPinned);
  EXPECT_EQ(recorded.diagnostics().rows.size(), 6u);
  EXPECT_EQ(recorded.frame_rate(), 50.0);
  EXPECT_THAT(recorded.warnings().back(), HasSubstr("Saved from the viewer"));
}

TEST_F(SavedRun, BeginsAnewWithTheRun) {
  const auto live = run();
  advance(*live, 3);
  live->reset();
  advance(*live, 1);
  EXPECT_EQ(live->saved_frames(), 2u);
  live->save(saved());
  EXPECT_EQ(RecordedRun(saved()).frame(1).time, 0.0);
}

TEST_F(SavedRun, OfADivergenceEndsWithTheLastFrameThatIsFinite) {
  const auto live = run(kDivergingScene);
  while (!live->failure()) live->step();
  live->save(saved());
  const RecordedRun recorded(saved());
  EXPECT_EQ(recorded.frames(), static_cast<int>(live->frame()));
  EXPECT_TRUE(recorded.frame(recorded.frames()).positions.allFinite());
  std::ifstream summary(saved() / "run.json");
  EXPECT_THAT(Json::parse(summary)["outcome"].get<std::string>(), HasSubstr("diverged"));
}

TEST_F(SavedRun, IsTheStartOfTheSceneThatNamesIt) {
  const auto live = run();
  advance(*live, 4);
  live->step();  // within a frame
  live->save(saved());
  const std::string scene = live->changed_scene("saved");
  const LoadedScene begun = load_scene({.file = folder_.write("next.json", scene).string()});
  EXPECT_EQ(begun.simulator.positions(), live->simulator().positions());
  EXPECT_EQ(begun.simulator.state().v, live->simulator().state().v);
}

TEST_F(SavedRun, LeavesNothingWhereItCannotBeWritten) {
  const auto live = run();
  folder_.write("saved", "a file of the user");
  EXPECT_THROW(live->save(saved()), FileError);
  EXPECT_TRUE(fs::is_regular_file(saved()));
  EXPECT_THROW(live->save(folder_.path() / "none" / "saved"), FileError);
  EXPECT_FALSE(fs::exists(folder_.path() / "none"));
}

TEST_F(SavedRun, TakesNamesOfNewFilesOfTheFolderAlone) {
  folder_.write("taken.html", "");
  fs::create_symlink(folder_.path() / "nowhere", saved("link"));
  for (const char* name : {"", ".", "..", "../up", "a/b", ".hidden", "-x", "a b", "caf\xc3\xa9", "link"}) {
    EXPECT_THROW((void)new_path(folder_.path(), name), InputError) << name;
  }
  EXPECT_THROW((void)new_path(folder_.path(), std::string(65, 'a')), InputError);
  EXPECT_THROW((void)new_path(folder_.path(), "taken", ".html"), InputError);
  EXPECT_EQ(new_path(folder_.path(), "taken"), saved("taken"));
  EXPECT_EQ(new_path(folder_.path(), std::string(64, 'a')).filename(), std::string(64, 'a'));
}

TEST_F(SavedRun, GoesOnFromAStateThatWasKept) {
  const auto live = run();
  std::vector<Points> first{live->simulator().positions()};
  for (int frame = 1; frame < 8; ++frame) {
    advance(*live, 1);
    first.push_back(live->simulator().positions());
  }
  ASSERT_TRUE(live->go_back(0.061));  // frame 4 is at 0.06 s
  EXPECT_EQ(live->frame(), 4u);
  EXPECT_EQ(live->simulator().positions(), first[3]);
  EXPECT_EQ(live->saved_frames(), 4u);
  advance(*live, 4);
  // New caches may change last digits.
  EXPECT_LT((live->simulator().positions() - first[7]).cwiseAbs().maxCoeff(), 1.0e-9);
  EXPECT_EQ(live->saved_frames(), 8u);
}

TEST_F(SavedRun, GoesBackToThePinsThatWereThere) {
  const auto live = run();
  advance(*live, 2);
  live->grab(10);
  live->drop(true);
  advance(*live, 2);
  live->grab(5);
  advance(*live, 2);
  const auto is_pinned = [&](Index i) { return live->simulator().state().activity.is_pinned(i); };
  ASSERT_TRUE(live->go_back(0.10)) << "from a pull to a frame with a pull";
  EXPECT_TRUE(is_pinned(10));
  ASSERT_TRUE(live->go_back(0.02));
  EXPECT_FALSE(is_pinned(10));
  live->reset();
  EXPECT_FALSE(is_pinned(10)) << "the hand has not set it yet";
}

TEST_F(SavedRun, GoesBackFromADivergence) {
  const auto live = run(kDivergingScene);
  while (!live->failure()) live->step();
  ASSERT_TRUE(live->go_back(0.02));
  EXPECT_FALSE(live->failure());
  live->step();
  EXPECT_EQ(live->frame(), 3u);
}

// Their steps are others, so that a state would not fit.
TEST_F(SavedRun, DoesNotGoBackBehindAnotherStep) {
  const auto live = run();
  advance(*live, 3);
  ASSERT_TRUE(live->change({"step=0.001"}));
  EXPECT_FALSE(live->go_back(0.02));
  advance(*live, 2);
  ASSERT_TRUE(live->go_back(0.02));
  EXPECT_EQ(live->frame(), 5u) << "the first state of the new step";
}

class SavingViewer : public SavedRun {
 protected:
  void serve(const fs::path& save_to = {}) {
    session_ = std::make_unique<LiveSession>(SceneSource{.file = folder_.write("scenes/scene.json", kScene).string()},
                                             std::vector<ExampleScene>{}, LiveSession::TellProblems{}, save_to);
    server_ = std::make_unique<ServingServer>(*session_);
  }
  ~SavingViewer() override {
    server_.reset();
    session_.reset();
  }
  [[nodiscard]] std::size_t files(const std::string& folder) const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(saved(folder)), {}));
  }

  std::unique_ptr<LiveSession> session_;
  std::unique_ptr<ServingServer> server_;
};

TEST_F(SavingViewer, SavesBesideTheSceneAndNeverTwiceUnderAName) {
  serve();
  TestPage page(server_->port());
  page.send({{"do", "pause"}});
  page.send({{"do", "save"}, {"as", "run"}, {"name", "first"}});
  const Json saved_run = page.text("saved");
  EXPECT_EQ(saved_run["name"], "first");
  EXPECT_THAT(saved_run["text"].get<std::string>(),
              HasSubstr((saved("scenes") / "first").string() + ". sprung view and sprung export read such folders."));
  EXPECT_GE(RecordedRun(saved("scenes") / "first").frames(), 1);
  page.send({{"do", "save"}, {"as", "run"}, {"name", "first"}});
  const Json refused = page.text("saved");
  EXPECT_EQ(refused["name"], "");
  EXPECT_THAT(refused["text"].get<std::string>(), HasSubstr("is taken"));
  page.send({{"do", "save"}, {"as", "page"}, {"name", "../up"}});
  EXPECT_EQ(page.text("saved")["name"], "");
  page.send({{"do", "save"}, {"as", "film"}, {"name", "other"}});
  EXPECT_THAT(page.text("error")["text"].get<std::string>(), HasSubstr("run or page"));
  EXPECT_EQ(files("scenes"), 2u);
  EXPECT_EQ(files("."), 1u) << "the scenes alone";
}

TEST_F(SavingViewer, SavesIntoTheFolderThatWasChosen) {
  fs::create_directories(saved("elsewhere"));
  serve(saved("elsewhere"));
  TestPage page(server_->port());
  page.send({{"do", "pause"}});
  page.send({{"do", "save"}, {"as", "page"}, {"name", "page"}});
  EXPECT_THAT(page.text("saved")["text"].get<std::string>(), HasSubstr("page.html. A page plays in any browser."));
  std::ifstream file(saved("elsewhere") / "page.html");
  const std::string html(std::istreambuf_iterator<char>(file), {});
  EXPECT_THAT(html, HasSubstr("<script type=\"application/json\" id=\"sprung-run\">"));
  page.send({{"do", "scene"}, {"run", 0}, {"state", "state"}});
  EXPECT_EQ(page.text("changed")["changed"]["initial_state"], "../elsewhere/state") << "seen from the scene";
  EXPECT_THAT(page.text("saved")["text"].get<std::string>(), HasSubstr("The present state is in"));
  EXPECT_EQ(files("elsewhere"), 2u);
  EXPECT_EQ(files("scenes"), 1u);
}

TEST_F(SavingViewer, GoesBackAndOnAsAPageAsks) {
  serve();
  TestPage page(server_->port());
  page.send({{"do", "pause"}});
  page.send({{"do", "reset"}});
  for (int k = 0; k < 6; ++k) page.send({{"do", "frame"}});
  const Received last = page.frame([](const Received& message) { return message.frame() == 7; });
  page.send({{"do", "rewind"}, {"time", 0.04}});
  const Received past = page.frame([](const Received& message) { return message.frame() == 3; });
  EXPECT_EQ(past.generation(), last.generation());
  page.send({{"do", "frame"}});
  EXPECT_EQ(page.frame([](const Received& message) { return message.time() > 0.05; }).frame(), 4u);
}

}  // namespace
}  // namespace sprung
