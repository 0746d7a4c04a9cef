#include "dynamics/stretch_newton/tree_solver.h"

namespace sprung {

TreeSolver::TreeSolver(const StretchComponent& component) : component_(component), nodes_(component.free_count) {
  for (const StretchComponent::Link& link : component.links) {
    if (component.is_free(link.second)) nodes_[link.first].parent = link.second;
  }
}

double TreeSolver::solve(const StretchSystem& system, Points& step) {
  step = system.residual;
  eliminate(system, step);
  for (Index i = component_.free_count - 1; i >= 0; --i) {
    const Node& node = nodes_[i];
    const Vector3 pull = node.parent == kNone ? Vector3(Vector3::Zero()) : node.upward * step.col(node.parent);
    step.col(i) = node.inverse * (step.col(i) + pull);
  }
  return 0.0;
}

// A point adds U - U (S + U)^-1 U to its parent, for the block U between them and the point's own stiffness S. The form U (S +
// U)^-1 S loses no digits when U is much larger.
void TreeSolver::eliminate(const StretchSystem& system, Points& step) {
  for (Index i = 0; i < component_.free_count; ++i)
    nodes_[i].own = SymmetricMatrix3::along(component_.masses[i], 0.0, Vector3::Zero());
  for (Index i = 0; i < component_.free_count; ++i) {
    Node& node = nodes_[i];
    node.upward = {};
    for (Index k = component_.begin[i]; k < component_.begin[i + 1]; ++k) {
      (component_.is_free(component_.links[k].second) ? node.upward : node.own) += system.blocks[k];
    }
    SymmetricMatrix3 all = node.own;
    all += node.upward;
    node.inverse = all.inverse();
    if (node.parent == kNone) continue;
    nodes_[node.parent].own += symmetric_product(node.upward, node.inverse, node.own);
    step.col(node.parent) += node.upward * (node.inverse * step.col(i));
  }
}

}  // namespace sprung
