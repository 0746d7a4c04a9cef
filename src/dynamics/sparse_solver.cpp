#include "dynamics/sparse_solver.h"

#include <limits>
#include <vector>

namespace sprung {
namespace {

BlockMatrix pattern_of(const StretchComponent& component) {
  std::vector<ParticlePair> pairs;
  for (const auto& link : component.links) {
    if (component.is_free(link.second)) pairs.push_back({.first = link.first, .second = link.second});
  }
  return {component.free_count, pairs};
}

}  // namespace

SparseSolver::SparseSolver(const StretchComponent& component)
    : component_(component), matrix_(pattern_of(component)), factor_(matrix_) {}

void SparseSolver::solve(const StretchSystem& system, Points& step) {
  assemble(system);
  if (factor_.factor(matrix_)) {
    factor_.solve(system.residual, step);
  } else {
    step.setConstant(3, component_.free_count, std::numeric_limits<double>::quiet_NaN());
  }
}

void SparseSolver::assemble(const StretchSystem& system) {
  matrix_.set_zero();
  for (Index i = 0; i < component_.free_count; ++i) matrix_.add(i, i, component_.masses[i] * Matrix3::Identity());
  for (std::size_t s = 0; s < component_.links.size(); ++s) {
    const auto& link = component_.links[s];
    const Matrix3 block = system.blocks[s].matrix();
    if (component_.is_free(link.second)) {
      matrix_.add_difference(link.first, link.second, block);
    } else {
      matrix_.add(link.first, link.first, block);
    }
  }
}

}  // namespace sprung
