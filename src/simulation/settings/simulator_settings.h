// Settings of a simulation.
#pragma once

#include "base/types.h"
#include "dynamics/air/surface_drag.h"
#include "dynamics/air/wind.h"
#include "dynamics/integrators/integrator_settings.h"
#include "dynamics/tethers/stretch_limit_settings.h"

#include <cstdint>
#include <optional>

namespace sprung {

/// How contact responds, and what happens to intersections at the start.
struct ContactSettings {
  enum class Response : std::uint8_t {
    projection,  ///< constraints on positions and velocities
    penalty      ///< f_coll: a spring and damper push particles out of obstacles
  };
  enum class Start : std::uint8_t {
    refuse,   ///< throw InputError
    push_out  ///< move bodies out of obstacles, and of each other, before time 0
  };
  Response response = Response::projection;
  Start start = Start::refuse;
  double stiffness = 0.0;  ///< of the penalty [N/m]
  double damping = 0.0;    ///< of the penalty [N s/m]
};

enum class StabilityCheck : std::uint8_t { refuse, warn };

/// Upper bound of the number of substeps in a step.
inline constexpr int kMaxSubsteps = 1 << 16;
inline constexpr int kMaxInnerSubsteps = 64;

struct SimulatorSettings {
  double step = 1.0e-3;  ///< dt [s]
  /// Number of steps of a frame, >= 1. A frame ends where state().step_in_frame == 0. The step may change there, the duration of a
  /// frame never: to lengthen the step later, begin with several steps per frame.
  int steps_per_frame = 1;
  double frame_rate = 0.0;           ///< [1/s]; messages advise steps that divide a frame; 0: any step
  Vector3 gravity{0.0, -9.81, 0.0};  ///< [m/s^2]
  double air_drag = 0.0;             ///< by length of ropes [kg/(m s)], by area of surfaces [kg/(m^2 s)]
  SurfaceDrag air_surface{};         ///< of the faces of bodies without a drag of their own, in addition
  Wind wind{};
  IntegratorSettings integrator = VerletSettings{};
  std::optional<StretchLimitSettings> stretch_limit{};
  ContactSettings contact{};
  StabilityCheck stability = StabilityCheck::refuse;
  /// Maximum number of substeps in a step, in [1, kMaxSubsteps]; see StepPlanner. All of them are made while Gauss-Seidel passes
  /// solve a limit that may be handed over to a global solve.
  int max_substeps = 1;
  /// Parts of each substep in which forces, the stretch limit and its contacts act, while contacts are found and paths are checked
  /// once: in [1, kMaxInnerSubsteps]. More than 1 requires contact by projection and a scheme other than implicit Euler. Where
  /// global solves enforce all limits and forces bear the whole step, there is one.
  int inner_substeps = 1;
  /// Whether particles at rest sleep; see RestDetector and Surroundings.
  bool sleep = true;
  /// Whether bodies that stand compressed, exactly in a line or plane, get a tiny push off it; see SymmetryBreaker.
  bool perturb = true;
  std::uint64_t seed = 0;  ///< of the directions of such pushes
  /// Whether steps record the impulses of pins and springs, for Simulator::reactions and limit_tensions. Changes no other result.
  bool record_forces = false;
  /// Whether steps record the impulses of contact, for Simulator::contact_forces. Changes no other result.
  bool record_contact_forces = false;

  /// The longest interval in which forces act [s].
  [[nodiscard]] double longest_substep() const { return step / inner_substeps; }

  /// Whether the air acts on all bodies. It also acts on those that have a drag of their own: see Body::drag.
  [[nodiscard]] bool has_air() const { return air_drag > 0.0 || !air_surface.is_zero(); }
};

/// Whether inner_substeps may be more than 1.
[[nodiscard]] bool may_have_inner_substeps(const SimulatorSettings& settings);

}  // namespace sprung
