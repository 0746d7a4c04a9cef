// Dampers apart from the other forces: a step of the springs holds several passes over the dampers.
//
// At fixed positions, dampers are linear in the velocities: dv/dt = -M^-1 C v. The passes of a step evaluate a polynomial of
// M^-1 C by the recurrence of Chebyshev polynomials T, as stabilized Runge-Kutta methods do (van der Houwen and Sommeijer 1980):
//     v* = P v,  P = (T_s(w0 - w1 M^-1 C) + kOffset) / (T_s(w0) + kOffset).
// s passes are stable up to a rate that grows with s^2. They act at the begin of a step, before the other forces. Constraints and
// contact have then removed the velocities that they oppose, so the dampers do not change an equilibrium with them. The scheme v' =
// P v
// - dt M^-1 K x, x' = x + dt v' is stable if dt^2 w^2 <= 2 (1 + P) for each mode of the frequency w. The offset keeps P above 0.62.
// Automatic steps are at most 0.9 of those that springs alone permit, so that dt^2 w^2 <= 3.24 = 2 (1 + 0.62). Momentum and angular
// momentum are conserved, as by each damper.
#pragma once

#include "base/types.h"
#include "dynamics/forces/force.h"

#include <vector>

namespace sprung {

struct SimulationState;
struct SpringNetwork;

/// Most passes over the dampers in a step: it bounds their cost.
inline constexpr int kMostDamperPasses = 16;

/// Pass j computes v_j = last v_(j-1) + second_last v_(j-2) + gained M^-1 F(v_(j-1)).
struct DamperPass {
  double last = 1.0;
  double second_last = 0.0;
  double gained = 0.0;   ///< [s]
  double impulse = 0.0;  ///< the impulse of the step is the sum of these times F(v_(j-1)) [s]
};

/// The passes of a step, and the share of the last one in v*; the rest is the share of the first velocity.
struct DamperSeries {
  std::vector<DamperPass> passes;
  double share = 1.0;

  /// P for a mode of this rate [1/s].
  [[nodiscard]] double factor(double rate) const;
};

/// For a step of `dt` [s]. `rate` [1/s] is the largest eigenvalue of M^-1 C. As few passes as are stable, at most
/// kMostDamperPasses.
[[nodiscard]] DamperSeries damper_series(double dt, double rate);

/// The largest rate [1/s] for which damper_series() is stable.
[[nodiscard]] double most_damping_rate(double dt);

class DamperPasses {
 public:
  /// No dampers.
  explicit DamperPasses(const SpringNetwork& network) : network_(network) {}

  /// `rate` [1/s] is the largest eigenvalue of M^-1 C, at most most_damping_rate() of the largest step.
  void set(Forces dampers, double rate);

  [[nodiscard]] bool empty() const { return dampers_.empty(); }

  /// Damps the velocities of free particles for `dt` [s] at the positions `x` [m], 3 x n. Adds the impulses on pinned particles if
  /// the state records them.
  void apply(const Points& x, double dt, SimulationState& state);

 private:
  const SpringNetwork& network_;
  Forces dampers_;
  double rate_ = 0.0;
  // Scratch.
  Points first_;
  Points second_last_;
  Points total_;
};

}  // namespace sprung
