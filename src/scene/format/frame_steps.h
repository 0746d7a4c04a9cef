// How steps and frames fit together.
#pragma once

#include <optional>

namespace sprung {

/// A scene, or a command line, may ask for no more.
inline constexpr int kMostFrames = 10'000'000;
inline constexpr double kMostStepsPerFrame = 1e8;

/// floor(duration * frame_rate + 1e-9) + 1: frame 1 is the state at time 0.
[[nodiscard]] int frame_count(double duration, double frame_rate);

/// 1 / (frame_rate * step) when that is a whole number within 1e-9 (and the rounding of a double), else none.
[[nodiscard]] std::optional<int> steps_per_frame(double frame_rate, double step);

/// 1 / (frame_rate * steps) [s]
[[nodiscard]] double step_of(double frame_rate, double steps);

/// The least number of steps a frame whose step is at most `largest` [s] > 0; none when that is more than a frame may have.
[[nodiscard]] std::optional<int> fewest_steps_per_frame(double frame_rate, double largest);

}  // namespace sprung
