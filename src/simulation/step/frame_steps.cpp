#include "simulation/step/frame_steps.h"

#include "base/format.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {
namespace {

constexpr int kTypedDigits = 3;

double rounded_down(double step) { return std::stod(format_upper_bound(step, kTypedDigits)); }

bool has_all_typed_digits(double step) {
  return std::stod(format_number(step, kTypedDigits)) == step && std::stod(format_number(step, kTypedDigits - 1)) != step;
}

/// 1 / (frame_rate * step) if it is a whole number.
std::optional<int> whole_steps(double frame_rate, double step) {
  const double steps = 1.0 / (frame_rate * step);
  const double whole = std::round(steps);
  // The division and the decimal notation of the step cause an error of some units in the last place.
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * steps;
  if (!(whole >= 1.0) || whole > kMostStepsPerFrame || std::abs(steps - whole) > std::max(1e-9, rounding)) return std::nullopt;
  return static_cast<int>(whole);
}

}  // namespace

int frame_count(double duration, double frame_rate) { return static_cast<int>(std::floor(duration * frame_rate + 1e-9)) + 1; }

std::optional<int> steps_per_frame(double frame_rate, double step) {
  if (const auto whole = whole_steps(frame_rate, step)) return whole;
  const double steps = std::floor(1.0 / (frame_rate * step));
  if (!(steps >= 1.0) || steps > kMostStepsPerFrame || !has_all_typed_digits(step)) return std::nullopt;
  if (rounded_down(step_of(frame_rate, steps)) != step) return std::nullopt;
  return static_cast<int>(steps);
}

double step_of(double frame_rate, double steps) { return 1.0 / (frame_rate * steps); }

double step_meant(double frame_rate, double step, int steps) {
  return whole_steps(frame_rate, step) == steps ? step : step_of(frame_rate, steps);
}

std::string step_text(double frame_rate, int steps) {
  const double step = step_of(frame_rate, steps);
  for (int digits = 1; digits < std::numeric_limits<double>::max_digits10; ++digits) {
    const std::string text = format_upper_bound(step, digits);
    if (steps_per_frame(frame_rate, std::stod(text)) == steps) return text;
  }
  return format_number(step);
}

std::optional<int> fewest_steps_per_frame(double frame_rate, double largest) {
  double steps = std::max(1.0, std::floor(1.0 / (frame_rate * largest)));
  if (steps > kMostStepsPerFrame) return std::nullopt;
  while (step_of(frame_rate, steps) > largest) ++steps;
  return static_cast<int>(steps);
}

std::optional<double> step_to_type(double frame_rate, double largest) {
  if (frame_rate == 0.0) return rounded_down(largest);
  const auto fewest = fewest_steps_per_frame(frame_rate, largest);
  if (!fewest) return std::nullopt;
  for (double steps = *fewest; steps <= kMostStepsPerFrame; ++steps) {
    const double step = rounded_down(step_of(frame_rate, steps));
    if (steps_per_frame(frame_rate, step)) return step;
  }
  return std::nullopt;
}

}  // namespace sprung
