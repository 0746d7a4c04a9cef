#include "dynamics/force.h"

namespace sprung {

void Force::prepare(double) {}

double Force::energy(const Points&) const { return 0.0; }

void sum_forces(const Forces& forces, const Kinematics& at, Points& total) {
  total.setZero(3, at.x.cols());
  for (const auto& force : forces) {
    force->prepare(at.time);
    force->add(at, total);
  }
}

}  // namespace sprung
