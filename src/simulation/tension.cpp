#include "simulation/tension.h"

namespace sprung {

Scalars spring_tensions(const Simulator& simulator) {
  const Springs& springs = simulator.network().springs;
  const Points& x = simulator.state().x;
  const Points& v = simulator.state().v;
  Scalars tensions = simulator.limit_tensions();
  for (Index s = 0; s < springs.count(); ++s) {
    const Vector3 between = x.col(springs.second[s]) - x.col(springs.first[s]);
    const double length = between.norm();
    if (length == 0.0 || (springs.law(s).tension_only && length <= springs.rest_length[s])) continue;
    const double rate = between.dot(v.col(springs.second[s]) - v.col(springs.first[s])) / length;
    tensions[s] += springs.stiffness[s] * (length - springs.rest_length[s]) + springs.damping[s] * rate;
  }
  return tensions;
}

}  // namespace sprung
