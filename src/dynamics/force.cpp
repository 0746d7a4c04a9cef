#include "dynamics/force.h"

namespace sprung {

double Force::energy(const Points&) const { return 0.0; }

void sum_forces(const Forces& forces, const Kinematics& at, Points& total) {
  total.setZero(3, at.x.cols());
  for (const auto& force : forces) force->add(at, total);
}

}  // namespace sprung
