// Scenes that begin as another run ended.
#include "base/error.h"
#include "base/scratch_folder.h"
#include "output/run_output.h"
#include "scene/load_scene.h"
#include "simulation/diagnostics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sprung {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::ScratchFolder;

/// A cloth that falls on a ball, and a strip that tears and yields.
json first_scene() {
  return json::parse(R"({
    "duration": 0.6,
    "bodies": {
      "strip": {
        "shape": { "type": "cloth", "size": [0.2, 0.3], "resolution": [3, 4] }, "mass": 0.05,
        "springs": {
          "structural": { "stiffness": 40, "damping": 0.01, "break": 0.2, "yield": 0.05 }, "shear": { "stiffness": 5, "damping": 0.01 }
        },
        "place": { "position": [1, 1, 0] },
        "pins": [
          { "box": [[0.8, 1.1, -0.1], [1.2, 1.2, 0.1]] },
          { "box": [[0.8, 0.8, -0.1], [1.2, 0.9, 0.1]],
            "motion": { "keyframes": [ { "time": 0 }, { "time": 0.5, "position": [0, -0.2, 0] } ] } }
        ]
      },
      "cloth": {
        "shape": { "type": "cloth", "size": [0.4, 0.4], "resolution": [8, 8] }, "material": "cotton",
        "place": { "position": [0.02, 0.23, 0], "rotation": [-90, 0, 0] }
      }
    },
    "obstacles": { "ball": { "shape": { "type": "sphere", "radius": 0.2 }, "friction": 0.4 } }
  })");
}

class InitialState : public ::testing::Test {
 protected:
  InitialState() { run(first_scene()); }

  /// Runs a scene into the folder "former".
  void run(const json& scene, bool checkpoint = true, bool record = true) {
    std::filesystem::remove_all(scratch_ / "former");
    LoadedScene loaded = load_scene({.file = (scratch_ / "scene.json").string(), .text = scene.dump()});
    RunFacts facts{.scene = loaded.scene.resolved, .frames = loaded.frames, .sources = loaded.sources};
    facts.write_record = record;
    facts.checkpoint_interval = checkpoint ? 1e9 : 0.0;
    RunOutput output(OutputFolder(scratch_ / "former", false), facts, loaded.simulator);
    FrameRunner runner(loaded.simulator);
    for (int frame = 1; frame <= loaded.frames; ++frame) {
      output.write_frame(loaded.simulator, frame == 1 ? runner.first_frame() : runner.next_frame());
    }
    output.write_checkpoint_now(loaded.simulator, "");
    output.finish("done");
    former_ = loaded.simulator.state();
    for (const Body& body : loaded.simulator.network().bodies) former_first_[body.name] = body.first_particle;
  }

  [[nodiscard]] LoadedScene load(json scene) const {
    scene["initial_state"] = "former";
    return load_scene({.file = (scratch_ / "scene.json").string(), .text = scene.dump()});
  }

  [[nodiscard]] std::vector<std::string> problems(const json& scene) const {
    try {
      (void)load(scene);
    } catch (const InputError& error) {
      std::vector<std::string> texts;
      for (const Problem& problem : error.problems()) texts.push_back(to_string(problem));
      return texts;
    }
    return {};
  }

  ScratchFolder scratch_;
  SimulationState former_;
  std::map<std::string, Index> former_first_;  ///< first particle of each body
};

TEST_F(InitialState, EverythingComesAlong) {
  ASSERT_GT(former_.springs.broken_count(), 0);
  ASSERT_GT(std::ranges::count_if(former_.contact.slip.obstacle, [](Index k) { return k != kNone; }), 0);
  const LoadedScene loaded = load(first_scene());
  const SimulationState& state = loaded.simulator.state();
  EXPECT_EQ(state.x, former_.x);
  EXPECT_EQ(state.springs.broken, former_.springs.broken);
  EXPECT_EQ(state.springs.rest_lengths, former_.springs.rest_lengths);
  EXPECT_NE(state.springs.rest_lengths, loaded.simulator.model()->network().springs.rest_length) << "some yielded";
  EXPECT_EQ(state.contact.slip.obstacle, former_.contact.slip.obstacle);
  for (Index i = 0; i < loaded.simulator.network().particle_count(); ++i) {
    if (loaded.simulator.network().is_pinned(i)) continue;
    EXPECT_EQ(state.v.col(i), former_.v.col(i)) << i;
  }
  EXPECT_EQ(loaded.simulator.network().springs.count(),
            loaded.simulator.model()->network().springs.count() - state.springs.broken_count());
  EXPECT_THAT(loaded.warnings, Contains(HasSubstr("\"place\"")));
}

// The network remains the one at rest, so that a cloth that lies folded does not take its folds for its shape.
TEST_F(InitialState, RestShapesStay) {
  const LoadedScene plain = load_scene({.file = (scratch_ / "scene.json").string(), .text = first_scene().dump()});
  const LoadedScene loaded = load(first_scene());
  EXPECT_EQ(loaded.simulator.model()->network().positions, plain.simulator.model()->network().positions);
  EXPECT_EQ(loaded.simulator.settings().step, plain.simulator.settings().step);
}

TEST_F(InitialState, TheOrderOfBodiesAndObstaclesDoesNotCount) {
  json scene = first_scene();
  scene["bodies"] = json::object();
  scene["obstacles"] = {{"another", {{"shape", {{"type", "sphere"}, {"radius", 0.1}}}, {"place", {{"position", {0, -5, 0}}}}}},
                        {"ball", first_scene()["obstacles"]["ball"]}};
  for (const char* name : {"cloth", "strip"}) scene["bodies"][name] = first_scene()["bodies"][name];
  const LoadedScene loaded = load(scene);
  const SpringNetwork& network = loaded.simulator.network();
  const Body& cloth = network.bodies[network.bodies[0].name == "cloth" ? 0 : 1];
  const Index first_before = former_first_["cloth"];
  const SimulationState& state = loaded.simulator.state();
  EXPECT_EQ(state.x.middleCols(cloth.first_particle, cloth.particle_count),
            former_.x.middleCols(first_before, cloth.particle_count));
  for (Index k = 0; k < cloth.particle_count; ++k) {
    const Index before = former_.contact.slip.obstacle[static_cast<std::size_t>(first_before + k)];
    EXPECT_EQ(state.contact.slip.obstacle[static_cast<std::size_t>(cloth.first_particle + k)], before == kNone ? kNone : 1);
  }
}

// Pins that move take their particles from where these are, in the direction of the keyframes.
TEST_F(InitialState, PinsMoveFromWhereTheirParticlesAre) {
  LoadedScene loaded = load(first_scene());
  Simulator& simulator = loaded.simulator;
  const Index pinned = [&] {
    for (Index i = 0; i < simulator.network().particle_count(); ++i) {
      const Index pin = simulator.state().activity.pin_of[static_cast<std::size_t>(i)];
      if (pin != kNone && simulator.network().pins[static_cast<std::size_t>(pin)].moves()) return i;
    }
    return kNone;
  }();
  ASSERT_NE(pinned, kNone);
  FrameRunner runner(simulator);
  while (simulator.time() < 0.5) (void)runner.next_frame();
  const Vector3 moved = simulator.positions().col(pinned) - former_.x.col(pinned);
  EXPECT_NEAR((moved - Vector3(0.0, -0.2, 0.0)).norm(), 0.0, 1e-12) << moved.transpose();
}

TEST_F(InitialState, DifferencesAreNamed) {
  json scene = first_scene();
  scene["bodies"]["cloth"]["shape"]["resolution"] = {9, 8};
  scene["bodies"]["flag"] = scene["bodies"]["strip"];
  scene["bodies"].erase("strip");
  const std::vector<std::string> found = problems(scene);
  EXPECT_THAT(found, Contains(HasSubstr("body \"cloth\" has 64 particles and 210 springs, not 72 particles and")));
  EXPECT_THAT(found, Contains(HasSubstr("body \"flag\" is missing")));
  EXPECT_THAT(found, Contains(HasSubstr("body \"strip\" is new")));
  EXPECT_THAT(found, ::testing::Each(HasSubstr("initial_state = \"former\"")));
}

TEST_F(InitialState, BrokenSpringsNeedABodyThatMayBreak) {
  json scene = first_scene();
  scene["bodies"]["strip"]["springs"]["structural"].erase("break");
  EXPECT_THAT(problems(scene),
              Contains(HasSubstr("that broke in \"initial_state\" may not break here; give the body the \"break\"")));
}

TEST_F(InitialState, YieldedSpringsNeedABodyThatMayYield) {
  json scene = first_scene();
  scene["bodies"]["strip"]["springs"]["structural"].erase("yield");
  EXPECT_THAT(problems(scene), Contains(HasSubstr("may not yield here; give the body the shape and the \"yield\"")));
}

TEST_F(InitialState, ABodyOfTheSameSizeWithOtherSpringsIsAnother) {
  json scene = first_scene();
  scene["bodies"]["strip"]["shape"]["resolution"] = {4, 3};
  EXPECT_THAT(problems(scene), Contains(HasSubstr("body \"strip\" has springs between other particles")));
}

TEST_F(InitialState, AnOverlapIsTreatedAsAtAnyStart) {
  json scene = first_scene();
  scene["obstacles"]["box"] = {{"shape", {{"type", "box"}, {"size", {0.1, 0.1, 0.1}}}},
                               {"place", {{"position", {0.02, 0.2, 0.0}}}}};
  EXPECT_THAT(problems(scene), Contains(HasSubstr("move an obstacle by \"place\", which does not move bodies that begin as another "
                                                  "run ended")));
  scene["contact"]["start"] = "push_out";
  EXPECT_THAT(problems(scene), IsEmpty());
}

TEST_F(InitialState, ComesFromTheRecordWithoutACheckpoint) {
  run(first_scene(), false);
  const LoadedScene loaded = load(first_scene());
  EXPECT_EQ(loaded.simulator.state().x, former_.x);
  EXPECT_EQ(loaded.simulator.state().springs.broken, former_.springs.broken);
  EXPECT_THAT(loaded.warnings, Not(Contains(HasSubstr("velocities of 0"))));
  EXPECT_THAT(loaded.warnings, Contains(HasSubstr("begins with the rest lengths of the shape")));
}

TEST_F(InitialState, OfObjFilesAloneHasNoVelocities) {
  json scene = first_scene();
  scene["duration"] = 0.1;  // before anything breaks
  run(scene, false, false);
  const LoadedScene loaded = load(scene);
  EXPECT_TRUE(loaded.simulator.state().x.isApprox(former_.x, 1e-15));
  EXPECT_TRUE(loaded.simulator.state().v.isZero(0.0) || loaded.simulator.state().v.colwise().norm().maxCoeff() < 1.0)
      << "only pins move";
  EXPECT_THAT(loaded.warnings, Contains(HasSubstr("velocities of 0")));
}

TEST_F(InitialState, AMissingFolderIsAProblem) {
  json scene = first_scene();
  scene["initial_state"] = "nowhere";
  try {
    (void)load_scene({.file = (scratch_ / "scene.json").string(), .text = scene.dump()});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no such folder: looked for"));
  }
}

TEST_F(InitialState, ADamagedCheckpointIsAnError) {
  testing::write_text(scratch_ / "former/checkpoint.bin", "sprungck");
  EXPECT_THROW((void)load(first_scene()), FileError);
}

}  // namespace
}  // namespace sprung
