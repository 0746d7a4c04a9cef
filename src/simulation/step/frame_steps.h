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

/// 1 / (frame_rate * step) if it is a whole number within 1e-9 (and the rounding of a double). A step with exactly three
/// significant digits also stands for the step of which it is the value rounded down: 0.0333 for 1 / 30. Otherwise none.
[[nodiscard]] std::optional<int> steps_per_frame(double frame_rate, double step);

/// 1 / (frame_rate * steps) [s]
[[nodiscard]] double step_of(double frame_rate, double steps);

/// The step [s] that a `step` from a user stands for, of which a frame has `steps` by steps_per_frame().
[[nodiscard]] double step_meant(double frame_rate, double step, int steps);

/// step_of() as a decimal for users to type: the shortest for which steps_per_frame() is `steps`.
[[nodiscard]] std::string step_text(double frame_rate, int steps);

/// The smallest number of steps per frame for which the step is at most `largest` [s] > 0; none if it exceeds kMostStepsPerFrame.
[[nodiscard]] std::optional<int> fewest_steps_per_frame(double frame_rate, double largest);

/// A step [s] for users to type: the largest of at most three significant digits that is at most `largest` [s] > 0 and that
/// steps_per_frame() accepts; any number of steps if frame_rate is 0. None beyond kMostStepsPerFrame.
[[nodiscard]] std::optional<double> step_to_type(double frame_rate, double largest);

}  // namespace sprung
