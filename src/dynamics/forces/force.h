// Forces on particles.
#pragma once

#include "dynamics/numerics/block_matrix.h"
#include "network/simulation_state.h"

#include <memory>
#include <vector>

namespace sprung {

/// What forces are evaluated at.
struct Kinematics {
  const Points& x;    ///< positions [m], 3 x n
  const Points& v;    ///< velocities [m/s], 3 x n
  double time = 0.0;  ///< [s]
};

/// How forces change, as implicit schemes take it: symmetric matrices without positive eigenvalues.
struct ForceDerivatives {
  BlockMatrix by_position;  ///< dF/dx [N/m]
  BlockMatrix by_velocity;  ///< dF/dv [N s/m]
};

class Force {
 public:
  virtual ~Force() = default;

  /// Called before forces are evaluated at a `time` [s]; not thread-safe. Default: nothing.
  virtual void prepare(double time);

  /// Whether `add` adds the same at all positions, velocities and times. Default: it does not.
  [[nodiscard]] virtual bool is_constant() const;

  /// Adds the forces [N] on all particles to `forces`, 3 x n. Thread-safe; the same bits for any number of threads.
  virtual void add(const Kinematics& at, Points& forces) const = 0;

  /// Adds the pairs of particles beside the diagonal that `add_derivatives` writes to, at whatever positions. Default: none.
  virtual void couple(std::vector<ParticlePair>& pairs) const;

  /// Adds the force's derivatives, as far as they are symmetric and pull back what moves: what would push it on, such as a
  /// compressed spring that gives way sideways, is left out (Baraff and Witkin 1998 call it filtering). Default: none.
  virtual void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const;

  /// Potential energy [J]; 0 for forces that have none.
  [[nodiscard]] virtual double energy(const Points& positions) const;
};

using Forces = std::vector<std::unique_ptr<Force>>;

/// Whether their sum is the same at all positions, velocities and times.
[[nodiscard]] bool are_constant(const Forces& forces);

/// Sum of all forces [N], 3 x n, written to `total`.
void sum_forces(const Forces& forces, const Kinematics& at, Points& total);

/// Derivatives of all forces, all zero: their pairs are there for `differentiate`.
[[nodiscard]] ForceDerivatives make_derivatives(const Forces& forces, Index particles);

/// Derivatives of the sum of all forces, written to `derivatives`, which `make_derivatives` made of the same forces.
void differentiate(const Forces& forces, const Kinematics& at, ForceDerivatives& derivatives);

}  // namespace sprung
