// The interface of forces on particles.
#pragma once

#include "dynamics/numerics/block_matrix.h"
#include "network/model/simulation_state.h"

#include <memory>
#include <vector>

namespace sprung {

/// The state at which forces are evaluated.
struct Kinematics {
  const Points& x;    ///< positions [m], 3 x n
  const Points& v;    ///< velocities [m/s], 3 x n
  double time = 0.0;  ///< [s]
};

/// The derivatives of forces for implicit schemes: symmetric matrices without positive eigenvalues.
struct ForceDerivatives {
  BlockMatrix by_position;  ///< dF/dx [N/m]
  BlockMatrix by_velocity;  ///< dF/dv [N s/m]
};

class Force {
 public:
  virtual ~Force() = default;

  /// Prepares the force for evaluations at `time` [s]. Not thread-safe. Default: does nothing.
  virtual void prepare(double time);

  /// Whether `add` adds the same force at all positions, velocities and times. Default: no.
  [[nodiscard]] virtual bool is_constant() const;

  /// Adds the forces [N] on all particles to `forces`, 3 x n. Thread-safe. Gives the same bits for any number of threads.
  virtual void add(const Kinematics& at, Points& forces) const = 0;

  /// Appends the off-diagonal pairs that `add_derivatives` writes to at any position. Default: none.
  virtual void couple(std::vector<ParticlePair>& pairs) const;

  /// Adds the symmetric, restoring part of the derivatives. Parts that would amplify a motion, such as the sideways buckling of a
  /// compressed spring, are left out (filtering, Baraff and Witkin 1998). Default: none.
  virtual void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const;

  /// Potential energy [J]; 0 for a force without a potential.
  [[nodiscard]] virtual double energy(const Points& positions) const;
};

using Forces = std::vector<std::unique_ptr<Force>>;

/// Whether the sum of all forces is the same at all positions, velocities and times.
[[nodiscard]] bool are_constant(const Forces& forces);

/// Writes the sum of all forces [N], 3 x n, to `total`.
void sum_forces(const Forces& forces, const Kinematics& at, Points& total);

/// Zero derivatives with the pairs of all forces, and with further ones, for `differentiate`.
[[nodiscard]] ForceDerivatives make_derivatives(const Forces& forces, Index particles, std::vector<ParticlePair> pairs = {});

/// Writes the derivatives of the sum of all forces to `derivatives`, which `make_derivatives` made for the same forces.
void differentiate(const Forces& forces, const Kinematics& at, ForceDerivatives& derivatives);

}  // namespace sprung
