// Forces on particles.
#pragma once

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

class Force {
 public:
  virtual ~Force() = default;

  /// Called before forces are evaluated at a `time` [s]; not thread-safe. Default: nothing.
  virtual void prepare(double time);

  /// Adds the forces [N] on all particles to `forces`, 3 x n. Thread-safe; the same bits for any number of threads.
  virtual void add(const Kinematics& at, Points& forces) const = 0;

  /// Potential energy [J]; 0 for forces that have none.
  [[nodiscard]] virtual double energy(const Points& positions) const;
};

using Forces = std::vector<std::unique_ptr<Force>>;

/// Sum of all forces [N], 3 x n, written to `total`.
void sum_forces(const Forces& forces, const Kinematics& at, Points& total);

}  // namespace sprung
