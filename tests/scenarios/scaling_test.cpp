// Scaling a scene and its gravity by a power of two scales all positions bit for bit: the code contains no absolute length or
// speed.
#include "base/scratch_folder.h"
#include "scenarios/scenario.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <set>
#include <string>
#include <vector>

namespace sprung::testing {
namespace {

using Json = nlohmann::json;

/// Multiplies all values in m, m/s or m/s^2. A mesh is a file, so its scale is multiplied.
void scale_lengths(Json& json, double factor) {
  static const std::set<std::string> kLengths = {"gravity", "size",  "position", "velocity",  "radius", "height",
                                                 "length",  "radii", "offset",   "thickness", "from",   "to"};
  const auto scale_numbers = [&](Json& value) {
    if (value.is_array()) {
      for (Json& number : value) number = number.get<double>() * factor;
    } else {
      value = value.get<double>() * factor;
    }
  };
  if (json.contains("shape") && json["shape"]["type"] == "mesh")
    json["place"]["scale"] = json["place"].value("scale", 1.0) * factor;
  for (auto& [key, value] : json.items()) {
    if (kLengths.contains(key)) {
      scale_numbers(value);
    } else if (value.is_structured()) {
      scale_lengths(value, factor);
    }
  }
}

struct ScaledRun {
  ScenarioReport report;
  std::vector<Points> frames;
};

ScaledRun run_scaled(double factor, double step_factor, Judge judge) {
  const ScratchFolder scratch;
  Json scene = Json::parse(read_text(SPRUNG_SOURCE_DIR "/tests/scenarios/scenes/bodies_on_everything.json"));
  scale_lengths(scene, factor);
  write_text(scratch / "scaled.json", scene.dump());
  ScaledRun run;
  run.report = run_scenario(
      load_scenario((scratch / "scaled").string(), {}, step_factor),
      [&](const Simulator& simulator, const FrameDiagnostics&) { run.frames.push_back(simulator.positions()); }, judge);
  return run;
}

class Scaling : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(StepFactor, Scaling, ::testing::Values(1.0, 0.5));

TEST_P(Scaling, ByAPowerOfTwoScalesPositionsBitForBit) {
  const ScaledRun expected = run_scaled(1.0, GetParam(), Judge::obstacles);
  EXPECT_TRUE(expected.report.is_free()) << expected.report;
  for (const double factor : {1.0 / 128.0, 128.0}) {
    const ScaledRun run = run_scaled(factor, GetParam(), Judge::nothing);
    ASSERT_EQ(run.report.step, expected.report.step);
    ASSERT_EQ(run.frames.size(), expected.frames.size());
    for (std::size_t frame = 0; frame < run.frames.size(); ++frame) {
      ASSERT_TRUE(run.frames[frame] == factor * expected.frames[frame])
          << "frame " << frame + 1 << " of the scene times " << factor;
    }
  }
}

}  // namespace
}  // namespace sprung::testing
