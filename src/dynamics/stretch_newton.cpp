#include "dynamics/stretch_newton.h"

#include "base/parallel.h"
#include "dynamics/component_newton.h"

#include <algorithm>
#include <utility>

namespace sprung {

StretchNewton::StretchNewton(const SpringNetwork& network, const StretchLimitSettings& settings) {
  for (StretchComponent& component : stretch_components(network, settings.kinds)) {
    if (component.is_tree || settings.solver != StretchLimitSettings::Solver::automatic) {
      components_.push_back(std::make_unique<ComponentNewton>(std::move(component), settings));
    } else {
      left_.insert(left_.end(), component.points.begin(), component.points.begin() + component.free_count);
    }
  }
  std::ranges::sort(left_);
}
StretchNewton::~StretchNewton() = default;

std::optional<int> StretchNewton::solve(const Points& before, Points& positions, double fall) {
  std::vector<std::optional<int>> iterations(components_.size());
  parallel_chunks(static_cast<Index>(components_.size()), 1, [&](Index begin, Index end) {
    for (Index c = begin; c < end; ++c) iterations[c] = components_[c]->solve(before, positions, fall);
  });
  return iterations.empty() ? std::nullopt : *std::ranges::max_element(iterations);
}

double StretchNewton::turn() const {
  double largest = 0.0;
  for (const auto& component : components_) largest = std::max(largest, component->turn());
  return largest;
}

bool StretchNewton::holds(const Body& body) const {
  const auto first = std::ranges::lower_bound(left_, body.first_particle);
  return first == left_.end() || *first >= body.first_particle + body.particle_count;
}

}  // namespace sprung
