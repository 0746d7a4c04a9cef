// All integration schemes, for tests of laws that are valid for each of them.
#pragma once

#include "dynamics/integrators/integrator.h"

#include <vector>

namespace sprung {

/// All schemes, each undamped.
inline std::vector<IntegratorSettings> all_integrators() {
  return {ExplicitEulerSettings{},  SymplecticEulerSettings{}, VerletSettings{},
          VelocityVerletSettings{}, RungeKutta4Settings{},     ImplicitEulerSettings{}};
}

}  // namespace sprung
