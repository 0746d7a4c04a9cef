// Pins and obstacles that a program moves.
#include "network/model/spring_failure.h"
#include "simulation/stepper.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace sprung {
namespace {

/// The first pose, and the poses at which pins gripped particles before `now` [s]: such particles move by the change of pose since.
std::vector<TimedPose> poses_of_grips(const SteeredMotion& steered, const std::vector<PinGrip>& grips, double now) {
  const double first = steered.poses.front().time;
  std::set<double> times;
  for (const PinGrip& grip : grips) {
    if (grip.time > first && grip.time < now) times.insert(grip.time);
  }
  const Motion motion{.poses = steered.poses};
  std::vector<TimedPose> poses{steered.poses.front()};
  for (const double time : times) poses.push_back({time, motion.pose(steered.poses.front().pose, time)});
  return poses;
}

/// Pins that a program added, and those of the same name and particles that it steers, go on in a model with other pins.
void keep_pins(const std::vector<Pin>& before, const std::vector<Pin>& after, const std::vector<Index>& pin_of,
               SimulationState& state) {
  Steering& steering = state.steering;
  std::vector<SteeredMotion> kept;
  for (SteeredMotion& steered : steering.pins) {
    if (steered.number >= before.size()) {
      steered.number += after.size() - before.size();
    } else {
      const auto same = std::ranges::find_if(after, [&](const Pin& pin) { return are_alike(pin, before[steered.number]); });
      if (same == after.end()) continue;
      steered.number = static_cast<std::size_t>(same - after.begin());
    }
    kept.push_back(std::move(steered));
  }
  std::ranges::sort(kept, {}, &SteeredMotion::number);
  steering.pins = std::move(kept);
  state.activity.phases.insert(state.activity.phases.end(), steering.added_pins.size(), PinPhase::holding);
  for (std::size_t i = 0; i < pin_of.size(); ++i) {
    const auto pin = static_cast<std::size_t>(pin_of[i]);
    if (pin_of[i] != kNone && pin >= before.size()) {
      state.activity.pin_of[i] = static_cast<Index>(pin + after.size() - before.size());
    }
  }
}

/// A move that the next step makes takes the whole of it, however long it is. Steps change at the end of a frame.
void fit_moves(const SimulatorSettings& next, const SimulatorSettings& before, SimulationState& state) {
  if (next.step == before.step) return;
  const double now = static_cast<double>(whole_steps(state)) * before.step;
  const double end = static_cast<double>(state.frame * next.steps_per_frame + 1) * next.step;
  for (auto list : {&Steering::pins, &Steering::obstacles}) {
    for (SteeredMotion& steered : state.steering.*list) {
      double& last = steered.poses.back().time;
      if (last > now + 0.5 * before.step) last = end;
    }
  }
}

}  // namespace

SimulationState continued_in(const Model& next, const Model& before, const SimulationState& state) {
  SimulationState continued = state;
  fit_moves(next.settings(), before.settings(), continued);
  continued.springs = carried_over(before.network(), state.springs, next.network());
  if (std::ranges::equal(before.network().pins, next.network().pins, are_alike)) return continued;
  continued.activity = all_free(next.network());
  keep_pins(before.network().pins, next.network().pins, state.activity.pin_of, continued);
  change_pins(next.network().pins, due_before(whole_steps(state), before.settings().step), continued.activity);
  return continued;
}

void Stepper::steer(std::vector<SteeredMotion> Steering::*list, std::size_t number, const RigidTransform& present,
                    const RigidTransform& target) {
  std::vector<SteeredMotion>& all = state_.steering.*list;
  const double now = time();
  const double end = static_cast<double>(whole_steps(state_) + 1) * settings().step;
  auto steered = std::ranges::lower_bound(all, number, {}, &SteeredMotion::number);
  const bool is_new = steered == all.end() || steered->number != number;
  if (is_new) steered = all.insert(steered, {.number = number, .poses = {{now, present}}});
  const BeforeTransition before = is_new ? before_transition() : BeforeTransition();
  std::vector<TimedPose> poses = poses_of_grips(*steered, state_.grips, now);
  if (now > poses.front().time) poses.push_back({now, present});
  poses.push_back({end, target});
  steered->poses = std::move(poses);
  if (is_new) {
    const std::vector<char> sleepers = state_.rest.sleepers;  // without those that a change woke
    make_transition(before);
    state_.rest.sleepers = sleepers;
  } else {
    follow_steering();
  }
  wake_driven();
}

void Stepper::follow_steering() {
  scratch_.follow(model_, control_, state_);
  work().pin_paths.register_pins(state_);
  move_pins(time());
}

}  // namespace sprung
