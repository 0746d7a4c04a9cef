// Dampers apart from the other forces: a step of the springs holds several shorter ones of the dampers.
//
// At fixed positions, dampers are linear in the velocities: dv/dt = -M^-1 C v. Explicit Euler steps of different lengths, the
// inverse roots of a Chebyshev polynomial, are together stable for a rate that grows with the square of their number (Richardson
// 1910; Alexiades, Amiez and Gremaud 1996, "super time stepping"). Two equal series of them multiply each mode by a square, hence
// never by a negative number: v* = P v with 0 <= P < 1. Then (P^-1 - 1) M / dt is a damper that acts implicitly, and leapfrog
// schemes are stable up to the bound of their springs alone. Momentum and spin stay, as they do with each damper's force.
#pragma once

#include "base/types.h"
#include "dynamics/forces/force.h"

#include <vector>

namespace sprung {

struct SimulationState;
struct SpringNetwork;

/// Most steps of dampers in a step: it bounds their cost.
inline constexpr int kMostDamperSteps = 16;

/// The lengths [s] of one of the two series for a step of `dt` [s]; they add up to dt / 2. `rate` [1/s] is the largest eigenvalue
/// of M^-1 C. As few as are stable, at most half of kMostDamperSteps; the shortest first, so that no mode grows meanwhile by more
/// than rounding.
[[nodiscard]] std::vector<double> damper_steps(double dt, double rate);

/// The largest rate [1/s] for which damper_steps() is stable.
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
  Points total_;  ///< scratch
};

}  // namespace sprung
