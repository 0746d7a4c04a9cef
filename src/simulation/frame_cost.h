// What a frame costs: measured at the start of a simulation, estimated for full contact.
#pragma once

#include "simulation/simulator.h"

#include <functional>
#include <optional>
#include <string>

namespace sprung {

/// measure_frame_cost() ends after this number of steps, before a step that would end after this time if it took as long as the one
/// before it, or before the first substep that begins after this time.
inline constexpr int kMostMeasuredSteps = 10;
inline constexpr double kLongestMeasurement = 1.0;  ///< [s]

/// Wall times of a frame in which all bodies move. Bodies at rest or asleep cost less. `full` is equal to `free` if nothing can
/// touch and there is no stretch limit.
struct FrameCost {
  int steps = 0;           ///< number of measured steps; 0 if the first one took longer than the measurement may
  double free = 0.0;       ///< as the simulation begins [s]; without a measured step a lower bound
  double full = 0.0;       ///< with all vertices in contact that can touch anything, and the stretch limit at work [s], >= free
  bool can_touch = false;  ///< whether any vertex can touch an obstacle or another element
  std::optional<std::string> failure{};  ///< why the simulation diverged during the measurement
};

/// Wall time [s] since a fixed moment.
using Clock = std::function<double()>;

/// The steady clock of the system.
[[nodiscard]] double steady_time();

/// Makes up to kMostMeasuredSteps steps. A free frame costs the median of their times, times `steps_per_frame`; `full` adds
/// the estimated cost of contact and of the stretch limit with `threads` threads. Requires a simulator at time 0. Advances it by
/// the measured steps; do not use it afterwards.
[[nodiscard]] FrameCost measure_frame_cost(Simulator& simulator, int steps_per_frame, int threads, const Clock& now = steady_time);

}  // namespace sprung
