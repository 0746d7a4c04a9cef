// Dampers apart from the other forces: each step makes several passes over the dampers.
//
// At fixed positions, dampers are linear in the velocities: dv/dt = -M^-1 C v. The s passes of a step evaluate a polynomial of
// M^-1 C by the recurrence of Chebyshev polynomials T, as stabilized Runge-Kutta methods do (van der Houwen and Sommeijer 1980):
//
//     v* = P v,  P = (T_s(w0 - w1 M^-1 C) + kOffset) / (T_s(w0) + kOffset)
//
// - They are stable up to a rate of about 0.27 s^2 / dt.
// - They act at the begin of a step, before the other forces. Constraints and contact have then removed the velocities that they
//   oppose, so the dampers do not change an equilibrium.
// - The scheme v' = P v - dt M^-1 K x, x' = x + dt v' is stable if dt^2 w^2 <= 2 (1 + P) for each mode of the angular frequency w.
//   Automatic steps have dt w <= 0.9 * 2, so that P >= 0.62 is needed. The offset ensures it.
// - Momentum and angular momentum are conserved, as by each damper.
#pragma once

#include "base/types.h"
#include "dynamics/forces/force.h"

#include <vector>

namespace sprung {

struct SimulationState;
struct SpringNetwork;

/// The most passes over the dampers in a step. Bounds their cost.
inline constexpr int kMostDamperPasses = 16;

/// Pass j computes v_j = last v_(j-1) + second_last v_(j-2) + gain M^-1 F(v_(j-1)).
struct DamperPass {
  double last = 1.0;
  double second_last = 0.0;
  double gain = 0.0;     ///< [s]
  double impulse = 0.0;  ///< the dampers' impulse in the step is the sum of impulse F(v_(j-1)) over all passes [s]
};

/// The passes of a step: v* = share v_s + (1 - share) v_0.
struct DamperSeries {
  std::vector<DamperPass> passes;
  double share = 1.0;

  /// P for a mode that the dampers damp at this rate [1/s].
  [[nodiscard]] double factor(double rate) const;
};

/// The passes of a step of `dt` [s], as few as are stable and at most kMostDamperPasses. `rate` [1/s] is the largest eigenvalue of
/// M^-1 C.
[[nodiscard]] DamperSeries damper_series(double dt, double rate);

/// The largest rate [1/s] for which damper_series() is stable.
[[nodiscard]] double most_damping_rate(double dt);

/// Dampers, and the passes that let them act on a state.
class DamperPasses {
 public:
  /// Without dampers. Keeps a reference to the network.
  explicit DamperPasses(const SpringNetwork& network) : network_(network) {}

  /// Replaces the dampers. `rate` [1/s] is the largest eigenvalue of M^-1 C, at most most_damping_rate() of the largest step.
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
