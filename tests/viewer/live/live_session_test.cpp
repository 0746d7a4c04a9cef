// Laws of the live viewer, as a page sees them through the server.
#include "viewer/live/live_session.h"
#include "base/error.h"
#include "base/format.h"
#include "scene/scene_text.h"
#include "viewer/rope_scenes.h"
#include "viewer/test_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <future>
#include <thread>

namespace sprung {
namespace {

using testing::get;
using ::testing::HasSubstr;
using testing::Json;
using testing::kDivergingScene;
using testing::kScene;
using testing::Received;
using testing::ServingServer;
using testing::TestPage;

constexpr const char* kHempScene = R"({"version": 1, "duration": 1, "frame_rate": 50,
  "bodies": {"rope": {"shape": {"type": "rope", "from": [0, 0, 0], "to": [0, -1, 0], "particles": 11}, "material": "hemp",
                      "pins": [{"indices": [0]}]}}})";

/// The rope falls from its horizontal start and breaks at its hook.
std::string breaking_scene() {
  std::string text = kScene;
  return text.insert(text.find("\"damping\": 0.1"), "\"break\": 0.01, ");
}

class LiveViewer : public ::testing::Test {
 protected:
  void serve(const std::string& text = kScene) {
    session_ = std::make_unique<LiveSession>(SceneSource{.file = folder_.write("scene.json", text).string()}, examples_);
    server_ = std::make_unique<ServingServer>(*session_);
  }
  ~LiveViewer() override {
    server_.reset();
    session_.reset();
  }

  SceneFolder folder_;
  std::vector<ExampleScene> examples_;
  std::unique_ptr<LiveSession> session_;
  std::unique_ptr<ServingServer> server_;
};

/// A page on a simulation that rests, at its first frame.
class PausedPage : public TestPage {
 public:
  explicit PausedPage(const std::string& port) : TestPage(port) {
    const auto playing = text("scene")["generation"].get<std::uint32_t>();
    send({{"do", "pause"}});
    send({{"do", "reset"}});
    frame([&](const Received& message) { return message.generation() > playing; });
  }
};

TEST_F(LiveViewer, ThePageComesWithTheTokenOnly) {
  serve();
  const std::string host = "127.0.0.1:" + server_->port();
  EXPECT_EQ(get(server_->port(), "/?token=secret", host).body, testing::kPage);
  for (const auto& answer : {get(server_->port(), "/", host), get(server_->port(), "/?token=secret", "evil.example"),
                             get(server_->port(), "/?token=secret", host, "http://evil.example"),
                             get(server_->port(), "/other?token=secret", host), get(server_->port(), "/live", host)}) {
    EXPECT_EQ(answer.status, 403u);
    EXPECT_THAT(answer.body, HasSubstr("token"));
  }
}

TEST_F(LiveViewer, APageIsToldTheSceneThenItsTopologyThenFrames) {
  serve();
  TestPage page(server_->port());
  EXPECT_EQ(page.receive().json()["type"], "hello");
  const Json scene = page.text("scene");
  EXPECT_EQ(scene["bodies"][0]["name"], "rope");
  EXPECT_EQ(scene["bodies"][0]["count"], 11);
  EXPECT_EQ(scene["obstacles"][0]["motion"], "fixed");
  EXPECT_EQ(scene["steps_per_frame"], 10);
  EXPECT_EQ(scene["integrator"], "verlet");
  const Received topology = page.binary();
  EXPECT_EQ(topology.kind(), 1u);
  EXPECT_EQ(topology.at<std::uint32_t>(32), 0u) << "triangles";
  EXPECT_EQ(topology.at<std::uint32_t>(36), 10u) << "segments";
  EXPECT_EQ(topology.at<std::uint32_t>(40), 10u) << "springs";
  EXPECT_EQ(topology.at<std::uint32_t>(44), 1u) << "obstacles";
  const Received frame = page.frame();
  EXPECT_EQ(frame.particles(), 11u);
  EXPECT_EQ(frame.generation(), scene["generation"]);
  EXPECT_EQ(frame.position(0), Vector3::Zero());
  const Received later = page.frame([&](const Received& message) { return message.frame() >= frame.frame() + 3; });
  EXPECT_LT(later.position(10).y(), frame.position(10).y());
}

// The same program without the viewer writes the same bits.
TEST_F(LiveViewer, FramesHaveThePositionsOfTheSimulator) {
  serve();
  PausedPage page(server_->port());
  LoadedScene loaded = load_scene({.file = (folder_.path() / "scene.json").string()});
  for (int frame = 2; frame <= 4; ++frame) {
    page.send({{"do", "frame"}});
    for (int step = 0; step < loaded.simulator.settings().steps_per_frame; ++step) loaded.simulator.step();
    const Received shown =
        page.frame([&](const Received& message) { return message.frame() == static_cast<std::uint32_t>(frame); });
    EXPECT_EQ(shown.time(), loaded.simulator.time());
    for (std::size_t i = 0; i < 11; ++i) {
      EXPECT_EQ(shown.position(i), Vector3(loaded.simulator.positions().col(static_cast<Index>(i)).cast<float>().cast<double>()));
    }
  }
}

TEST_F(LiveViewer, APageIsToldTheTopologyThatABreakLeaves) {
  serve(breaking_scene());
  PausedPage page(server_->port());
  for (int frame = 0; frame < 50; ++frame) page.send({{"do", "frame"}});
  Received topology = page.binary();
  while (topology.kind() != 1u || topology.at<std::uint32_t>(40) == 10u) topology = page.binary();
  EXPECT_LT(topology.at<std::uint32_t>(36), 10u) << "segments";
  EXPECT_EQ(topology.at<std::uint32_t>(36), topology.at<std::uint32_t>(40)) << "a segment for each spring";
  // If the rope has broken again meanwhile, only frames of a later generation come.
  EXPECT_EQ(page.frame([&](const Received& frame) { return frame.generation() >= topology.generation(); }).particles(), 11u);
}

TEST_F(LiveViewer, ChangesAfterABreakLetTheRunGoOn) {
  serve(breaking_scene());
  PausedPage page(server_->port());
  for (int frame = 0; frame < 50; ++frame) page.send({{"do", "frame"}});
  Received topology = page.binary();
  while (topology.kind() != 1u || topology.at<std::uint32_t>(40) == 10u) topology = page.binary();
  const Received last = page.frame([](const Received& frame) { return frame.frame() == 51; });
  page.send({{"do", "set"}, {"run", 0}, {"key", "gravity"}, {"value", {0, 5, 0}}});
  Json scene = page.text("scene");
  while (scene["scene"]["gravity"] != Json({0, 5, 0})) scene = page.text("scene");
  EXPECT_TRUE(scene["live"]);
  topology = page.binary();
  while (topology.kind() != 1u || topology.generation() != scene["generation"]) topology = page.binary();
  EXPECT_LT(topology.at<std::uint32_t>(40), 10u) << "springs";
  EXPECT_EQ(page.frame().positions(), last.positions());
}

TEST_F(LiveViewer, ResetGivesTheBitsOfTheFirstFrame) {
  serve();
  PausedPage page(server_->port());
  page.send({{"do", "step"}});
  const Received first = page.frame([](const Received& message) { return message.time() > 0.0; });
  page.send({{"do", "frame"}});
  page.frame([](const Received& message) { return message.time() > 0.01; });
  page.send({{"do", "reset"}});
  const Received start = page.frame([](const Received& message) { return message.time() == 0.0; });
  EXPECT_NE(start.generation(), first.generation());
  page.send({{"do", "step"}});
  const Received again = page.frame([](const Received& message) { return message.time() > 0.0; });
  EXPECT_EQ(again.positions(), first.positions());
}

TEST_F(LiveViewer, GravityChangesWhileTheRunGoesOn) {
  serve();
  PausedPage page(server_->port());
  page.send({{"do", "frame"}});
  page.frame([](const Received& message) { return message.time() > 0.0; });
  page.send({{"do", "set"}, {"run", 0}, {"key", "gravity"}, {"value", {0, 5, 0}}});
  const Json scene = page.text("scene");
  EXPECT_TRUE(scene["live"]);
  EXPECT_EQ(scene["scene"]["gravity"], Json({0, 5, 0}));
  EXPECT_EQ(scene["changed"]["gravity"], Json({0, 5, 0}));
  EXPECT_FALSE(scene["changed"].contains("integrator")) << "what its author did not write";
  EXPECT_EQ(page.frame().time(), 0.02);
}

// A hemp rope that hangs still: wind blows it, a drag that is given takes the place of its own, and vacuum lets it be.
TEST_F(LiveViewer, TheAirOfAMaterialChangesWhileTheRunGoesOn) {
  LiveRun run({.file = folder_.write("scene.json", kHempScene).string()});
  const auto drag = [&] { return run.simulator().network().bodies[0].drag.line_diameter; };
  EXPECT_EQ(drag(), 0.012);
  run.step();
  EXPECT_TRUE(run.change({"air.wind=[6,0,0]"}));
  for (int step = 0; step < 100; ++step) run.step();
  EXPECT_GT(run.simulator().positions()(0, 10), 0.01);
  EXPECT_TRUE(run.change({"air.wind=[3,0,0]"}));
  EXPECT_TRUE(run.change({"air.drag=0.1"}));
  EXPECT_EQ(drag(), 0.0);
  EXPECT_TRUE(run.change({"air.drag=null"}));
  EXPECT_EQ(drag(), 0.012);
  EXPECT_TRUE(run.change({"air=false"}));
  EXPECT_EQ(drag(), 0.0);
}

TEST_F(LiveViewer, AnotherIntegratorBeginsTheRunAnew) {
  serve();
  PausedPage page(server_->port());
  page.send({{"do", "frame"}});
  page.frame([](const Received& message) { return message.time() > 0.0; });
  page.send({{"do", "set"}, {"key", "integrator"}, {"value", {{"type", "rk4"}}}});
  const Json scene = page.text("scene");
  EXPECT_FALSE(scene["live"]);
  EXPECT_EQ(scene["integrator"], "rk4");
  EXPECT_EQ(page.frame().time(), 0.0);
}

TEST_F(LiveViewer, ARefusedValueNamesTheRuleAndLeavesTheRun) {
  serve();
  PausedPage page(server_->port());
  for (const auto& [key, value] : std::vector<std::pair<std::string, Json>>{
           {"gravity", "down"}, {"bodies.rope.mass", -1}, {"step", 10.0}, {"integrator", {{"type", "eulr"}}}, {"nonsense", 1}}) {
    page.send({{"do", "set"}, {"run", 0}, {"key", key}, {"value", value}});
    const Json answer = page.text("problems");
    EXPECT_EQ(answer["key"], key);
    ASSERT_FALSE(answer["problems"].empty()) << key;
    EXPECT_FALSE(answer["problems"][0]["rule"].get<std::string>().empty()) << key;
  }
  page.send({{"do", "frame"}});
  EXPECT_EQ(page.frame().frame(), 2u);
}

TEST_F(LiveViewer, ASceneWithMistakesShowsThem) {
  serve(R"({"version": 1, "duration": -1, "bodies": {}})");
  TestPage page(server_->port());
  const Json answer = page.text("problems");
  EXPECT_TRUE(answer["run"].is_null());
  EXPECT_GE(answer["problems"].size(), 2u);
}

TEST_F(LiveViewer, APulledParticleMovesToTheTargetAndStaysWherePinned) {
  serve();
  PausedPage page(server_->port());
  page.send({{"do", "grab"}, {"run", 0}, {"particle", 10}});
  page.send({{"do", "drag"}, {"target", {0.0, 0.9, 0.0}}});
  for (int k = 0; k < 100; ++k) page.send({{"do", "frame"}});
  const Received pulled = page.frame([](const Received& message) { return message.frame() == 101; });
  EXPECT_LT((pulled.position(10) - Vector3(0.0, 0.9, 0.0)).norm(), 0.2);
  page.send({{"do", "drop"}, {"pin", true}});
  const Received pinned = page.frame();
  page.send({{"do", "frame"}});
  const Received later = page.frame([](const Received& message) { return message.frame() == 102; });
  EXPECT_EQ(later.position(10), pinned.position(10));
  EXPECT_NE(later.position(9), pinned.position(9));
  page.send({{"do", "release"}, {"run", 0}, {"particle", 10}});
  page.send({{"do", "frame"}});
  const Received freed = page.frame([](const Received& message) { return message.frame() == 103; });
  EXPECT_LT(freed.position(10).y(), later.position(10).y());
}

TEST_F(LiveViewer, TwoIntegratorsRunSideBySide) {
  serve();
  PausedPage page(server_->port());
  page.send({{"do", "compare"}, {"integrator", "implicit_euler"}});
  Json second = page.text("scene");
  while (second["run"] == 0) second = page.text("scene");
  EXPECT_EQ(second["integrator"], "implicit_euler");
  page.send({{"do", "frame"}});
  const auto moved = [](const Received& message) { return message.time() > 0.0; };
  const Received first = page.frame(moved);
  const Received other = page.frame(moved);
  EXPECT_NE(first.run(), other.run());
  EXPECT_NE(first.positions(), other.positions());
  page.send({{"do", "single"}});
  EXPECT_EQ(page.text("removed")["run"], 1);
}

TEST_F(LiveViewer, ADivergedRunTellsWhereAndWhichStepIsStable) {
  serve(kDivergingScene);
  TestPage page(server_->port());
  page.send({{"do", "speed"}, {"factor", 0}});
  const Json scene = page.text("scene");
  const Json post_mortem = page.text("diverged");
  EXPECT_EQ(post_mortem["generation"], scene["generation"]);
  EXPECT_EQ(post_mortem["body"], "rope");
  EXPECT_TRUE(post_mortem["springs"].size() == 1 || post_mortem.contains("particle"));
  const std::string advice = "use a step of at most " + format_number(post_mortem["stable_step"].get<double>());
  EXPECT_THAT(post_mortem["text"].get<std::string>(), HasSubstr(advice));
  page.send({{"do", "pause"}});
  page.send({{"do", "reset"}});
  EXPECT_EQ(page.frame([](const Received& message) { return message.frame() == 1; }).time(), 0.0);
}

// The step that the page offers is the one that the check of the scene advises, and the run does not diverge with it.
TEST_F(LiveViewer, TheOfferedStepIsTheOneThatValidationAdvises) {
  const std::string file = folder_.write("scene.json", kDivergingScene).string();
  LiveRun run({.file = file});
  while (!run.failure()) run.step();
  const std::optional<double> offered = run.failure()->smaller_step;
  ASSERT_TRUE(offered);
  try {
    (void)load_scene({.file = file, .overrides = {"stability=refuse"}});
    FAIL() << "the step is too large";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("use a step of at most " + format_number(*offered) + " s, or"));
  }
  run.change({"step=" + format_number(*offered)});
  for (int step = 0; step < 1000; ++step) run.step();
  EXPECT_FALSE(run.failure());
}

TEST_F(LiveViewer, UnknownMessagesGetAnAnswer) {
  serve();
  PausedPage page(server_->port());
  for (const Json& message : std::vector<Json>{Json::array(),
                                               {{"do", "dance"}},
                                               {{"do", 3}},
                                               {{"do", "set"}},
                                               {{"do", "grab"}, {"run", 7}, {"particle", 0}},
                                               {{"do", "grab"}, {"run", -1}, {"particle", 0}},
                                               {{"do", "set"}, {"run", 1}, {"key", "gravity"}, {"value", {0, 0, 0}}},
                                               {{"do", "release"}, {"run", 0}, {"particle", -5}},
                                               {{"do", "every"}, {"steps", 1e300}},
                                               {{"do", "speed"}, {"factor", nullptr}},
                                               {{"do", "obj"}, {"body", "none"}},
                                               {{"do", "drag"}, {"target", {1}}},
                                               {{"do", "open"}, {"example", "none"}}}) {
    page.send(message);
    EXPECT_FALSE(page.text("error")["text"].get<std::string>().empty()) << message;
  }
  // These name a particle that is not there, and are ignored.
  page.send({{"do", "grab"}, {"run", 0}, {"particle", 1000000}});
  page.send({{"do", "release"}, {"run", 0}, {"particle", 1000000}});
  page.send({{"do", "frame"}});
  EXPECT_EQ(page.frame([](const Received& message) { return message.time() > 0.0; }).frame(), 2u);
}

// A key that no scene has, as long as a message may be.
TEST_F(LiveViewer, ALongKeyIsRefusedAsAnyOther) {
  serve();
  PausedPage page(server_->port());
  for (const std::string& key :
       std::vector<std::string>{"gravity." + std::string(50'000, 'x'), std::string(50'000, '.'), "gravity=1", ""}) {
    page.send({{"do", "set"}, {"key", key}, {"value", 1}});
    EXPECT_FALSE(page.text("problems")["problems"].empty());
  }
}

TEST_F(LiveViewer, AChangeOfTheFileMeanwhileDoesNotChangeTheRun) {
  serve();
  PausedPage page(server_->port());
  folder_.write("scene.json", R"({"version": 1, "duration": -1})");
  page.send({{"do", "reset"}});
  EXPECT_EQ(page.text("scene")["bodies"][0]["name"], "rope");
  page.send({{"do", "set"}, {"key", "gravity"}, {"value", {0, 1, 0}}});
  EXPECT_TRUE(page.text("scene")["live"]);
}

// Softer springs permit longer automatic steps. The run keeps its own, which are stable too.
TEST_F(LiveViewer, AChangeThatWouldHaveOtherStepsKeepsThoseOfTheRun) {
  Json scene = Json::parse(kScene);
  scene["step"] = "auto";
  serve(scene.dump());
  const auto steps_with = [&](const std::vector<std::string>& overrides) {
    return load_scene({.file = (folder_.path() / "scene.json").string(), .overrides = overrides})
        .simulator.settings()
        .steps_per_frame;
  };
  const int steps = steps_with({});
  ASSERT_LT(steps_with({"bodies.rope.springs.structural.stiffness=10"}), steps);
  PausedPage page(server_->port());
  page.send({{"do", "frame"}});
  page.frame([](const Received& message) { return message.time() > 0.0; });
  page.send({{"do", "set"}, {"run", 0}, {"key", "bodies.rope.springs.structural.stiffness"}, {"value", 10}});
  const Json changed = page.text("scene");
  EXPECT_TRUE(changed["live"]);
  EXPECT_EQ(changed["steps_per_frame"], steps);
  EXPECT_EQ(page.frame().time(), 0.02);
}

// The ball's mesh is gone when the run is to begin anew.
TEST_F(LiveViewer, AResetThatFailsTellsWhyAndTheRunGoesOn) {
  const std::string tetrahedron = "v 0 -3 0\nv 1 -3 0\nv 0 -2 0\nv 0 -3 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::filesystem::path mesh = folder_.write("rock.obj", tetrahedron);
  Json scene = Json::parse(kScene);
  scene["obstacles"] = {{"rock", {{"shape", {{"type", "mesh"}, {"file", "rock.obj"}}}}}};
  serve(scene.dump());
  PausedPage page(server_->port());
  std::filesystem::remove(mesh);
  for (const Json& message : std::vector<Json>{{{"do", "reset"}}, {{"do", "compare"}, {"integrator", "rk4"}}}) {
    page.send(message);
    EXPECT_THAT(page.text("problems").dump(), HasSubstr("rock.obj"));
  }
  page.send({{"do", "frame"}});
  EXPECT_EQ(page.frame([](const Received& message) { return message.time() > 0.0; }).frame(), 2u);
}

// Explicit Euler takes much smaller steps than Verlet here.
TEST_F(LiveViewer, RunsWithDifferentStepsStaySideBySideInTime) {
  Json scene = Json::parse(kScene);
  scene["step"] = "auto";
  serve(scene.dump());
  PausedPage page(server_->port());
  page.send({{"do", "compare"}, {"integrator", "explicit_euler"}});
  std::array<double, 2> steps{};
  for (int k = 0; k < 2; ++k) {
    const Json shown = page.text("scene");
    steps.at(shown["run"]) = shown["step"];
  }
  ASSERT_LT(steps[1], 0.9 * steps[0]);
  for (const int every : {0, 3}) {
    page.send({{"do", "every"}, {"steps", every}});
    page.send({{"do", "reset"}});
    page.frame([](const Received& message) { return message.time() == 0.0; });
    page.send({{"do", "frame"}});
    const auto moved = [](int run) {
      return [run](const Received& m) { return m.run() == static_cast<std::uint32_t>(run) && m.time() > 0.0; };
    };
    const double first = page.frame(moved(0)).time();
    EXPECT_NEAR(page.frame(moved(1)).time(), first, steps[1]) << every;
  }
}

TEST_F(LiveViewer, APageThatLeavesLetsGoOfWhatItPulled) {
  serve();
  PausedPage watcher(server_->port());
  {
    TestPage other(server_->port());
    other.frame();
    other.send({{"do", "grab"}, {"run", 0}, {"particle", 10}});
    other.send({{"do", "drag"}, {"target", {0.0, 5.0, 0.0}}});
    other.send({{"do", "every"}, {"steps", 7}});
    while (other.text("state")["every"] != 7) continue;
  }
  double lowest = 0.0;
  for (std::uint32_t frame = 1; frame <= 60; ++frame) {
    watcher.send({{"do", "frame"}});
    const double time = frame * 7 * 0.002;
    const Received shown = watcher.frame([&](const Received& message) { return message.time() > time - 0.001; });
    lowest = std::min(lowest, shown.position(10).y());
  }
  EXPECT_LT(lowest, -0.5) << "it falls";
}

TEST_F(LiveViewer, AnExampleOpens) {
  examples_ = {{"other", folder_
                             .write("other.json", R"({"version": 1, "duration": 1, "bodies": {"one": {"shape":
    {"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "particles": 3}, "mass": 1, "springs": {"structural": {"stiffness": 1}}}}})")
                             .string()}};
  serve();
  TestPage page(server_->port());
  EXPECT_EQ(page.text("hello")["examples"][0]["name"], "other");
  page.text("scene");
  page.send({{"do", "open"}, {"example", "other"}});
  EXPECT_EQ(page.text("scene")["bodies"][0]["name"], "one");
}

TEST_F(LiveViewer, TenPagesSeeTheSameRunAndItRestsWithoutThem) {
  serve();
  std::vector<std::unique_ptr<TestPage>> pages;
  for (int k = 0; k < 10; ++k) pages.push_back(std::make_unique<TestPage>(server_->port()));
  double latest = 0.0;
  for (const auto& page : pages) latest = std::max(latest, page->frame([](const Received& m) { return m.time() > 0.0; }).time());
  pages.clear();
  std::this_thread::sleep_for(std::chrono::seconds(1));
  TestPage page(server_->port());
  EXPECT_LT(page.frame().time(), latest + 0.5);  // it plays at real time
}

TEST_F(LiveViewer, AResetLoadsASceneWhoseMistakesAreMended) {
  serve("{");
  TestPage page(server_->port());
  EXPECT_TRUE(page.text("problems")["run"].is_null());
  folder_.write("scene.json", kScene);
  page.send({{"do", "reset"}});
  EXPECT_EQ(page.text("scene")["bodies"][0]["name"], "rope");
}

TEST_F(LiveViewer, EndsAtOnceWhileManyMessagesWait) {
  serve();
  TestPage page(server_->port());
  page.text("scene");
  for (int k = 0; k < 5000; ++k) page.send({{"do", "reset"}});
  const auto begin = std::chrono::steady_clock::now();
  server_.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
}

// Its depth would make each path a text of its own length.
TEST_F(LiveViewer, AKeyWithManyLevelsIsRefusedAtOnce) {
  serve();
  PausedPage page(server_->port());
  std::string key = "a";
  for (int k = 0; k < 30000; ++k) key += ".a";
  page.send({{"do", "set"}, {"key", key}, {"value", 1}});
  EXPECT_LT(page.text("problems")["problems"][0]["text"].get<std::string>().size(), 1000u);
}

TEST_F(LiveViewer, ProblemsOfTheFirstSceneAreToldOnce) {
  std::promise<std::string> told;
  session_ =
      std::make_unique<LiveSession>(SceneSource{.file = folder_.write("scene.json", R"({"duration": -1})").string()}, examples_,
                                    [&](const std::vector<Problem>& problems) { told.set_value(to_string(problems.at(0))); });
  server_ = std::make_unique<ServingServer>(*session_);
  EXPECT_THAT(told.get_future().get(), HasSubstr("duration"));
  TestPage page(server_->port());
  page.send({{"do", "reset"}});  // a second call would throw
  EXPECT_THAT(page.text("problems").dump(), HasSubstr("duration"));
}

TEST_F(LiveViewer, ABusyPortIsNamedWithTheRemedy) {
  serve();
  LiveSession other(SceneSource{.file = (folder_.path() / "scene.json").string()}, {});
  try {
    ViewServer second({.port = static_cast<std::uint16_t>(std::stoi(server_->port())), .token = "t", .page = ""}, other);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--port"));
    EXPECT_THAT(error.what(), HasSubstr(server_->port()));
  }
}

TEST_F(LiveViewer, PinsOfTheHandStayThroughResetsAndRestarts) {
  LiveRun run({.file = folder_.write("scene.json", kScene).string()});
  run.grab(5);
  run.drop(true);
  run.release(0);
  const auto is_pinned = [](const LiveRun& of, Index i) { return of.simulator().state().activity.is_pinned(i); };
  const auto expect_pins = [&](const LiveRun& of) {
    EXPECT_TRUE(is_pinned(of, 5));
    EXPECT_FALSE(is_pinned(of, 0));
  };
  expect_pins(run);
  run.reset();
  expect_pins(run);
  EXPECT_FALSE(run.change({R"(integrator={"type":"symplectic_euler"})"}));
  expect_pins(run);
  LiveRun other({.file = (folder_.path() / "scene.json").string()});
  other.keep_pins(run);
  expect_pins(other);
  EXPECT_EQ(Json::parse(run.changed_scene())["bodies"]["rope"]["pins"].back()["indices"], Json::array({5}));
  EXPECT_FALSE(run.change({"bodies.rope.shape.particles=21"}));
  EXPECT_FALSE(is_pinned(run, 5)) << "particles have other numbers";
}

TEST_F(LiveViewer, AStepChangesAtTheEndOfTheFrame) {
  LiveRun run({.file = folder_.write("scene.json", kScene).string()});
  for (int k = 0; k < 13; ++k) run.step();  // of 10 a frame
  EXPECT_TRUE(run.change({"step=0.001"}));
  EXPECT_EQ(run.simulator().settings().step, 0.001);
  EXPECT_NEAR(run.simulator().time(), 0.04, 1.0e-12);
  run.step();
  EXPECT_NEAR(run.simulator().time(), 0.041, 1.0e-12);
}

TEST_F(LiveViewer, AFileThatChangesIsOpenedAgainAndItsMistakesAreTold) {
  serve();
  TestPage page(server_->port());
  page.text("scene");
  std::this_thread::sleep_for(std::chrono::seconds(1));  // the session has looked at the file
  folder_.write("scene.json", R"({"version": 1, "duration": -1})");
  EXPECT_EQ(page.text("problems")["problems"][0]["key"], "duration");
  std::string changed = kScene;
  changed.replace(changed.find("0.1,"), 4, "0.2,");
  folder_.write("scene.json", changed);
  EXPECT_EQ(page.text("scene")["scene"]["bodies"]["rope"]["mass"], 0.2);
  EXPECT_THAT(page.text("notice")["text"].get<std::string>(), HasSubstr("scene.json"));
}

TEST_F(LiveViewer, TheForceOfTheHandIsToldInNewtons) {
  LiveRun run({.file = folder_.write("scene.json", kScene).string()});
  EXPECT_EQ(run.numbers().pull, 0.0);
  run.grab(10);
  run.drag(run.simulator().positions().col(10) + Vector3(0.1, 0.0, 0.0));
  // k = m / s^2 of the body's 0.1 kg and 0.1 s, less what the step takes.
  EXPECT_NEAR(run.numbers().pull, 1.0, 0.5);
  run.drop(false);
  EXPECT_EQ(run.numbers().pull, 0.0);
}

}  // namespace
}  // namespace sprung
