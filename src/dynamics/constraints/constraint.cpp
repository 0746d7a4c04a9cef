#include "dynamics/constraints/constraint.h"

#include <algorithm>

namespace sprung {

void Constraint::prepare(double /*time*/) {}

std::optional<std::vector<Index>> Constraint::touched() const { return std::nullopt; }

double project(const Constraints& constraints, const Points& before, Points& positions, const ImpulseRecorder& recorder) {
  double largest = 0.0;
  for (const auto& constraint : constraints) largest = std::max(largest, constraint->project(before, positions, recorder));
  return largest;
}

double residual(const Constraints& constraints, const Points& positions) {
  double largest = 0.0;
  for (const auto& constraint : constraints) largest = std::max(largest, constraint->residual(positions));
  return largest;
}

}  // namespace sprung
