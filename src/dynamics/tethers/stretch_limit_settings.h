// The settings of the stretch limit.
#pragma once

#include "network/model/springs.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sprung {

/// A quarter of `max_stretch`, at least 0.001 [1].
[[nodiscard]] constexpr double default_tolerance(double max_stretch) { return std::max(0.25 * max_stretch, 0.001); }

struct StretchLimitSettings {
  enum class Solver : std::uint8_t {
    gauss_seidel,  ///< Gauss-Seidel passes alone
    newton,        ///< Newton's method before the passes
    automatic  ///< Newton's method for ropes, for cloths without stiffness that collide with nothing, and for bodies whose limit
               ///< passes keep missing
  };
  double max_stretch = 0.02;                              ///< >= 0: lengths stay below d (1 + max_stretch)
  double max_compression = 1.0;                           ///< in [0, 1]: lengths stay above d (1 - max_compression)
  std::vector<SpringKind> kinds{SpringKind::structural};  ///< which springs are limited
  int iterations =
      32;  ///< largest number of passes a step, >= 1; half as many an inner substep; more where surfaces stop particles
  double tolerance = default_tolerance(max_stretch);  ///< passes end at this excess over the limit, relative to d, >= 0
  bool tethers = false;                               ///< particles stay within reach of their pins: see LongRangeAttachments
  Solver solver = Solver::automatic;
  bool of_materials = false;  ///< whether it stands in for the stiffness of materials, so that nobody asked for it
};

/// Input of the automatic choice between passes and Newton's method.
struct LimitUse {
  bool may_collide = true;        ///< contact may oppose the solution
  bool takes_small_steps = true;  ///< springs or angle bends with stiffness need small steps, in which passes suffice
};

}  // namespace sprung
