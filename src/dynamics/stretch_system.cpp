#include "dynamics/stretch_system.h"

#include "dynamics/sparse_solver.h"
#include "dynamics/tree_solver.h"

namespace sprung {

std::unique_ptr<StretchSystemSolver> make_system_solver(const StretchComponent& component) {
  if (component.is_tree) return std::make_unique<TreeSolver>(component);
  return std::make_unique<SparseSolver>(component);
}

}  // namespace sprung
