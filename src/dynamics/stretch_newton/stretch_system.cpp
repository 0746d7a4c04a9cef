#include "dynamics/stretch_newton/stretch_system.h"

#include "dynamics/stretch_newton/pcg_solver.h"
#include "dynamics/stretch_newton/tree_solver.h"

namespace sprung {

std::unique_ptr<StretchSystemSolver> make_system_solver(const StretchComponent& component) {
  if (component.is_tree) return std::make_unique<TreeSolver>(component);
  return std::make_unique<PcgSolver>(component);
}

}  // namespace sprung
