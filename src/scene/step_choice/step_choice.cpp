#include "scene/step_choice/step_choice.h"

#include "base/format.h"
#include "dynamics/stretch_limit/stretch_limit.h"
#include "network/model/activity.h"
#include "scene/step_choice/many_steps.h"
#include "simulation/step/frame_steps.h"
#include "simulation/step/step_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace sprung {
namespace {

bool damps_steps(const IntegratorSettings& integrator) {
  const auto* verlet = std::get_if<VerletSettings>(&integrator);
  return verlet != nullptr && verlet->damping > 0.0;
}

bool may_have_substeps(const Scene& scene, const std::optional<StretchLimit>& limit) {
  return limit && (limit->bears_smaller_steps() || limit->follows_deformation()) && !damps_steps(scene.settings.integrator);
}

/// Whether a step may be as large as a frame: the turn of the last step determines its substeps, and no contact is possible.
bool is_bound_by_turn(const Scene& scene, const LimitUse& use, const std::optional<StretchLimit>& limit) {
  return may_have_substeps(scene, limit) && limit->follows_deformation() && !use.may_collide;
}

/// The largest step without regard to the passes of the stretch limit.
double largest_auto_step(const Scene& scene, const LimitUse& use, const std::optional<StretchLimit>& limit,
                         const SpectralBounds& bounds) {
  double largest = std::min(advised_step(scene.settings.integrator, bounds),
                            step_for_growth_time(scene.settings.integrator, bounds, scene.duration));
  const bool implicit = std::holds_alternative<ImplicitEulerSettings>(scene.settings.integrator);
  // The limit reverts displacements that springs make too large. Operator splitting then causes an error of that size.
  const bool is_split = implicit && limit && bounds.elastic > 0.0;
  const bool free = (implicit && !use.may_collide) || is_bound_by_turn(scene, use, limit);
  if (!std::isfinite(largest) && (is_split || !free)) largest = kLargestAutoStep;
  return largest;
}

/// The steps per frame that hold `needed` steps as substeps.
int whole_steps(int needed, int substeps) { return 1 + (needed - 1) / substeps; }

/// The number of substeps (a power of two) with which `without_passes` steps per frame come near the `needed` steps per frame,
/// without exceeding them; fewer if whole steps would then need many more. 1 if substeps are not allowed.
int substeps_for_passes(const Scene& scene, const std::optional<StretchLimit>& limit, int needed, int without_passes) {
  if (!limit || !limit->may_follow_deformation() || damps_steps(scene.settings.integrator)) return 1;
  constexpr double kMore = 1.0 / 8.0;
  int substeps = std::min(1 << std::ilogb(static_cast<double>(needed) / without_passes), kMaxSubsteps);
  while (whole_steps(needed, substeps) * substeps > (1.0 + kMore) * needed) substeps /= 2;
  return substeps;
}

/// Whether forces may act in inner substeps. Newton's method does not know contacts: where truncation stops its ropes, they lag
/// behind, in long contact steps by many times their length. Layers without a thickness leave no room for the motion of a long
/// contact step.
bool bears_long_contact_steps(const SpringNetwork& network, const std::optional<StretchLimit>& limit) {
  const auto has_no_gap = [](const Body& body) { return body.contact.self && body.material.thickness == 0.0; };
  if (std::ranges::any_of(network.bodies, has_no_gap)) return false;
  return !(limit && limit->uses_newton()) && std::ranges::none_of(network.attachments, &Attachment::is_rigid);
}

/// With so many inner substeps, forces act in steps that they bear, and half of the limit's passes leave an excess that is 2.6
/// times as large as in steps that StretchLimit::suggested_step() suggests. Measured on cloths of 64, 128 and 256 squared that
/// drape over a bunny: 99 in 100 springs are at most 2.7 % too long with a limit of 2 %.
int inner_substeps(double step, double for_forces, double for_passes) {
  constexpr double kLonger = 1.15;
  const double needed = std::ceil(step / std::min(for_forces, kLonger * for_passes));
  return static_cast<int>(std::clamp(needed, 1.0, static_cast<double>(kMaxInnerSubsteps)));
}

std::string advice_for_too_many_steps(const Scene& scene) {
  const bool gains_energy = std::holds_alternative<ExplicitEulerSettings>(scene.settings.integrator);
  return std::string(gains_energy ? "use \"symplectic_euler\", which does not gain energy at any step, " : "use ") +
         "less stiffness, more mass, or a higher frame_rate";
}

/// A step that divides no frame. Names the divisors beside it, of which the larger one may be too large to be stable.
Problem undivided_frame(const Scene& scene, double largest_stable) {
  const double steps = 1.0 / (scene.frame_rate * *scene.step);
  const bool refuses = scene.settings.stability == StabilityCheck::refuse;
  std::string remedy;
  for (const double whole : {std::floor(steps), std::ceil(steps)}) {
    if (whole < 1.0 || whole > kMostStepsPerFrame) continue;
    if (refuses && is_unstable(step_of(scene.frame_rate, whole), largest_stable)) continue;
    remedy += (remedy.empty() ? "use " : " or ") + step_text(scene.frame_rate, static_cast<int>(whole));
  }
  return {.file = scene.file.string(),
          .key = "step",
          .value = format_number(*scene.step),
          .rule = "must divide a frame: 1 / (frame_rate * step) is " + format_number(steps) + ", not a whole number",
          .remedy = (!remedy.empty()              ? remedy
                     : steps > kMostStepsPerFrame ? "use a larger step"
                                                  : "use a higher frame_rate") +
                    ", or \"auto\""};
}

/// The given step.
StepChoice given_step(const Scene& scene, const SpectralBounds& bounds, std::vector<Problem>& problems) {
  StepChoice choice;
  choice.largest_stable = largest_stable_step(scene.settings.integrator, bounds);
  const auto steps = steps_per_frame(scene.frame_rate, *scene.step);
  choice.steps_per_frame = steps.value_or(1);
  choice.step = steps ? step_meant(scene.frame_rate, *scene.step, *steps) : *scene.step;
  if (is_unstable(choice.step, choice.largest_stable) && scene.settings.stability == StabilityCheck::refuse) {
    SimulatorSettings settings = scene.settings;
    settings.step = choice.step;
    problems.push_back(unstable_step(settings, bounds));
    problems.back().value = format_number(*scene.step);  // as the user wrote it
    problems.back().file = scene.file.string();
  } else if (!steps) {
    problems.push_back(undivided_frame(scene, choice.largest_stable));
  }
  return choice;
}

/// The automatic step for the pins that hold in the network. Adds a problem if there is none.
StepChoice automatic_step(const Scene& scene, const SpringNetwork& network, const SpectralBounds& bounds,
                          std::vector<Problem>& problems) {
  StepChoice choice;
  std::optional<StretchLimit> limit;
  const LimitUse use = limit_use(network, scene.settings, !scene.obstacles.empty());
  if (scene.settings.stretch_limit) limit.emplace(network, *scene.settings.stretch_limit, use);
  const double without_passes = largest_auto_step(scene, use, limit, bounds);
  const double for_passes = limit ? limit->suggested_step(scene.settings.gravity.norm()) : std::numeric_limits<double>::infinity();
  const double for_layers = limit ? limit->step_for_layers(scene.settings.gravity.norm()) : std::numeric_limits<double>::infinity();
  const double for_contact = std::min(bears_long_contact_steps(network, limit) ? kLargestAutoStep : without_passes, for_layers);
  const bool has_inner = use.may_collide && std::min(without_passes, for_passes) < for_contact &&
                         may_have_inner_substeps(scene.settings) && !damps_steps(scene.settings.integrator);
  const double largest =
      has_inner ? std::min(for_contact, kMaxInnerSubsteps * without_passes) : std::min({without_passes, for_layers, for_passes});
  if (const auto steps = fewest_steps_per_frame(scene.frame_rate, largest)) {
    const int substeps =
        has_inner ? 1 : substeps_for_passes(scene, limit, *steps, *fewest_steps_per_frame(scene.frame_rate, without_passes));
    choice.steps_per_frame = whole_steps(*steps, substeps);
    choice.step = step_of(scene.frame_rate, choice.steps_per_frame);
    choice.max_substeps = has_inner || may_have_substeps(scene, limit) ? kAutoSubsteps : substeps;
    if (has_inner) choice.inner_substeps = inner_substeps(choice.step, without_passes, for_passes);
    choice.warning = many_steps_warning(scene, network, choice, for_passes < without_passes);
  } else {
    problems.push_back({scene.file.string(), "step", "\"auto\"",
                        "must be at most " + format_upper_bound(largest) + " s, which takes too many steps per frame",
                        advice_for_too_many_steps(scene)});
  }
  return choice;
}

}  // namespace

StepChoice choose_step(const Scene& scene, const SpringNetwork& network, std::vector<Problem>& problems) {
  const SpectralBounds bounds = simulation_bounds(network, scene.settings, !scene.obstacles.empty());
  if (scene.step) return given_step(scene, bounds, problems);
  StepChoice automatic = automatic_step(scene, network, bounds, problems);
  automatic.largest_stable = largest_stable_step(scene.settings.integrator, bounds);
  const std::vector<double> changes = pin_changes(network.pins);
  if (changes.empty()) return automatic;
  SpringNetwork later = network;
  for (const double time : changes) {
    if (!problems.empty()) break;
    Activity activity = later.activity;
    change_pins(later.pins, std::nextafter(time, std::numeric_limits<double>::infinity()), activity);
    set_activity(std::move(activity), later);
    StepChoice other = automatic_step(scene, later, bounds, problems);
    other.largest_stable = automatic.largest_stable;
    other.max_substeps = automatic.max_substeps = std::max(automatic.max_substeps, other.max_substeps);
    other.inner_substeps = automatic.inner_substeps = std::max(automatic.inner_substeps, other.inner_substeps);
    if (other.steps_per_frame > automatic.steps_per_frame) automatic = std::move(other);
  }
  return automatic;
}

}  // namespace sprung
