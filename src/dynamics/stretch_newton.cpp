#include "dynamics/stretch_newton.h"

#include "base/parallel.h"
#include "dynamics/component_newton.h"

#include <algorithm>
#include <utility>

namespace sprung {

StretchNewton::StretchNewton(const SpringNetwork& network, const StretchLimitSettings& settings) {
  for (StretchComponent& component : stretch_components(network, settings.kinds)) {
    components_.push_back(std::make_unique<ComponentNewton>(std::move(component), settings));
  }
}
StretchNewton::~StretchNewton() = default;

int StretchNewton::solve(const Points& before, Points& positions, double fall) {
  std::vector<int> iterations(components_.size(), 0);
  parallel_chunks(static_cast<Index>(components_.size()), 1, [&](Index begin, Index end) {
    for (Index c = begin; c < end; ++c) iterations[c] = components_[c]->solve(before, positions, fall);
  });
  return iterations.empty() ? 0 : *std::ranges::max_element(iterations);
}

}  // namespace sprung
