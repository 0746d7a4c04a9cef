// The schemes for tests of laws that hold for any scheme.
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
