// Dampers apart from the other forces: several passes over the dampers, once in up to four substeps.
//
// At fixed positions, dampers are linear in the velocities: dv/dt = -M^-1 C v. The s passes evaluate a polynomial of M^-1 C by the
// recurrence of Chebyshev polynomials T, as stabilized Runge-Kutta methods do (van der Houwen and Sommeijer 1980):
//
//     v* = P v,  P = T_s(w0 - w1 M^-1 C) / T_s(w0)
//
// - They are stable up to a rate of about 0.86 s^2 / dt: one damping of four substeps needs fewer passes than four dampings.
// - They act on the velocities v_n at the time of the positions x_n. A scheme with velocities half a step apart, which advances by
//   v_(n+1/2) = v_(n-1/2) + dt a_n, adds dt/2 a_n before and after. It conserves v_n^T M v_n + x_n^T K (1 - dt^2/4 M^-1 K) x_n, in
//   which no product mixes x and v: as |P| <= 1, dampers only lower it, at any step that is stable without them.
// - Momentum and angular momentum are conserved, as by each damper.
#pragma once

#include "base/types.h"
#include "dynamics/forces/force.h"

#include <vector>

namespace sprung {

struct SimulationState;
struct SpringNetwork;

/// Materials whose dampers would need more passes have weaker ones.
inline constexpr int kMostDamperPasses = 32;

/// Dampers act once in so many substeps of a step, for all of them.
inline constexpr int kDamperInterval = 4;

/// Pass j computes v_j = last v_(j-1) + second_last v_(j-2) + gain M^-1 F(v_(j-1)).
struct DamperPass {
  double last = 1.0;
  double second_last = 0.0;
  double gain = 0.0;     ///< [s]
  double impulse = 0.0;  ///< the dampers' impulse is the sum of impulse F(v_(j-1)) over all passes [s]
};

struct DamperSeries {
  std::vector<DamperPass> passes;

  /// P for a mode that the dampers damp at this rate [1/s].
  [[nodiscard]] double factor(double rate) const;
};

/// The passes for `dt` [s], as few as are stable. `rate` [1/s] is the largest eigenvalue of
/// M^-1 C.
[[nodiscard]] DamperSeries damper_series(double dt, double rate);

/// The largest rate [1/s] for which damper_series() has at most kMostDamperPasses.
[[nodiscard]] double most_damping_rate(double dt);

/// Dampers, and the passes that let them act on a state.
class DamperPasses {
 public:
  /// Without dampers. Keeps a reference to the network.
  explicit DamperPasses(const SpringNetwork& network) : network_(network) {}

  /// Replaces the dampers. `rate` [1/s] is the largest eigenvalue of M^-1 C, at most most_damping_rate() of the longest time that
  /// they act for.
  void set(Forces dampers, double rate);

  [[nodiscard]] bool empty() const { return dampers_.empty(); }

  /// Whether they act at the begin of the present substep.
  [[nodiscard]] bool are_due(const SimulationState& state) const;

  /// If they are due, damps the velocities of free particles at the positions `x` [m], 3 x n, for the substeps of `dt` [s] until
  /// they are due again. Adds the impulses on pinned particles if the state records them.
  void apply(const Points& x, double dt, SimulationState& state);

  /// The same for velocities half a step before `x`, where the other forces are `forces` [N], 3 x n.
  void apply_between(const Points& x, const Points& forces, double dt, SimulationState& state);

 private:
  const SpringNetwork& network_;
  Forces dampers_;
  double rate_ = 0.0;
  // Scratch.
  Points second_last_;
  Points total_;
};

}  // namespace sprung
