// Steps and frames.
#pragma once

#include <optional>
#include <string>

namespace sprung {

/// Bounds for scenes and command lines.
inline constexpr int kMostFrames = 10'000'000;
inline constexpr double kMostStepsPerFrame = 1e8;

/// floor(duration * frame_rate + 1e-9) + 1: frame 1 is the state at time 0.
[[nodiscard]] int frame_count(double duration, double frame_rate);

/// 1 / (frame_rate * step) if it is a whole number within 1e-9 (and the rounding of a double), otherwise none.
[[nodiscard]] std::optional<int> steps_per_frame(double frame_rate, double step);

/// 1 / (frame_rate * steps) [s]
[[nodiscard]] double step_of(double frame_rate, double steps);

/// step_of() as a decimal for users to type: the shortest for which steps_per_frame() is `steps`.
[[nodiscard]] std::string step_text(double frame_rate, int steps);

/// The smallest number of steps per frame for which the step is at most `largest` [s] > 0; none if it exceeds kMostStepsPerFrame.
[[nodiscard]] std::optional<int> fewest_steps_per_frame(double frame_rate, double largest);

/// The step [s] of fewest_steps_per_frame().
[[nodiscard]] std::optional<double> largest_step_of_frame(double frame_rate, double largest);

}  // namespace sprung
