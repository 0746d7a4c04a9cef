// Runs scenes with the real simulator and judges every frame.
#pragma once

#include "base/error.h"
#include "scene/building/scene_builder.h"
#include "simulation/diagnostics.h"
#include "simulation/simulator.h"

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace sprung::testing {

/// Loads the scene tests/scenarios/scenes/<name>.json (or <name>.json, if that is an absolute path) with overrides as given to
/// --set. The step is `step_factor` times the step that the scene itself leads to. A larger step gives fewer frames, with as many
/// steps each; a smaller one gives more steps a frame.
[[nodiscard]] BuiltScene load_scenario(const std::string& name, const std::vector<std::string>& overrides = {},
                                       double step_factor = 1.0);

/// The same for scenes with stiff springs, such as jellies. Explicit schemes choose a step almost as long as the springs allow, so
/// a longer step is made with implicit Euler.
[[nodiscard]] BuiltScene load_stiff_scenario(const std::string& name, double step_factor);

/// The judge's findings in all frames, including the first.
struct ScenarioReport {
  int frames = 0;
  double step = 0.0;  ///< [s]
  Index inside = 0;   ///< particles inside obstacles, added up over frames
  Index crossings = 0;
  Index self_crossings = 0;
  int first_wrong_frame = 0;  ///< 0: none is wrong
  int last_wrong_frame = 0;
  int first_infeasible_frame = 0;  ///< 0: none has infeasible particles
  double max_stretch = 0.0;
  Index truncated = 0;
  Index infeasible = 0;
  Index inverted = 0;  ///< cells that end inside out in bodies that preserve their volume
  double simulation_seconds = 0.0;
  double judge_seconds = 0.0;
  std::optional<StepFailure> divergence{};  ///< after the last frame

  [[nodiscard]] bool is_free() const { return first_wrong_frame == 0; }
};
std::ostream& operator<<(std::ostream& stream, const ScenarioReport& report);

/// What is judged in each frame.
enum class Judge : std::uint8_t { nothing, obstacles, obstacles_and_self };

/// Is called after each frame, including the first.
using Watch = std::function<void(const Simulator& simulator, const FrameDiagnostics& frame)>;

/// Throws StepError when the network diverges, InputError when it cannot start.
ScenarioReport run_scenario(BuiltScene scene, const Watch& watch = {}, Judge judge = Judge::obstacles);

/// Ends with the last frame before a divergence. Throws InputError when the network cannot start, StoppedError when `stops` is
/// true.
ScenarioReport run_until_divergence(BuiltScene scene, const Watch& watch, Judge judge, const std::function<bool()>& stops);

/// A vector as JSON.
[[nodiscard]] std::string json_text(const Vector3& v);

/// The smallest distance [m] of a particle from an obstacle at present, by the judge's own measure.
[[nodiscard]] double least_distance(const Simulator& simulator);

}  // namespace sprung::testing
