// The settings of the stretch limit.
#pragma once

#include "network/spring_network.h"

#include <vector>

namespace sprung {

struct StretchLimitSettings {
  enum class Solver : std::uint8_t {
    gauss_seidel,  ///< passes alone
    newton,        ///< a global solve before them
    automatic      ///< a global solve of ropes, of limp cloths that meet nothing, and of those whose limit passes keep missing
  };
  double max_stretch = 0.02;                              ///< >= 0: lengths stay below d (1 + max_stretch)
  double max_compression = 1.0;                           ///< in [0, 1]: and above d (1 - max_compression)
  std::vector<SpringKind> kinds{SpringKind::structural};  ///< which springs it holds
  int iterations = 32;                                    ///< most passes a step, >= 1; more where surfaces stop particles
  double tolerance = 0.001;                               ///< excess over the limit, as a part of d, at which passes end, >= 0
  bool tethers = false;                                   ///< particles stay within reach of their pins: see Tethers
  Solver solver = Solver::gauss_seidel;
};

/// What an automatic solver begins with passes for, of what it could solve for.
struct LimitUse {
  bool may_meet_anything = true;  ///< contact may be in the way of what it does
  bool takes_small_steps = true;  ///< where springs or angle bends have stiffness, for their sake: passes do well in them
};

}  // namespace sprung
