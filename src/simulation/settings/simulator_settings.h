// The settings of a simulation that is made in code.
#pragma once

#include "dynamics/integrators/integrator.h"
#include "dynamics/stretch_limit/stretch_limit.h"

#include <optional>

namespace sprung {

struct ContactSettings {
  enum class Response : std::uint8_t {
    projection,  ///< particles are moved out of obstacles
    penalty      ///< f_coll: a spring and damper push them out
  };
  enum class Start : std::uint8_t {
    refuse,   ///< what intersects at the start is refused
    push_out  ///< what is in obstacles is led out of them before time 0
  };
  Response response = Response::projection;
  Start start = Start::refuse;
  double stiffness = 0.0;  ///< of the penalty [N/m]
  double damping = 0.0;    ///< of the penalty [N s/m]
};

enum class StabilityCheck : std::uint8_t { refuse, warn };

/// A step is not made in more parts.
inline constexpr int kMaxSubsteps = 1 << 16;

struct SimulatorSettings {
  double step = 1.0e-3;              ///< dt [s]
  Vector3 gravity{0.0, -9.81, 0.0};  ///< [m/s^2]
  double air_drag = 0.0;             ///< [kg/s] per particle of a rope, [kg/(m^2 s)] for surfaces
  Vector3 wind = Vector3::Zero();    ///< [m/s]
  IntegratorSettings integrator = VerletSettings{};
  std::optional<StretchLimitSettings> stretch_limit{};
  ContactSettings contact{};
  StabilityCheck stability = StabilityCheck::refuse;
  /// In [1, kMaxSubsteps]: steps are made in up to so many parts, see StepRefinement; in all of them while passes hold a limit that
  /// may be handed over to a global solve, which then needs fewer.
  int max_substeps = 1;
};

}  // namespace sprung
