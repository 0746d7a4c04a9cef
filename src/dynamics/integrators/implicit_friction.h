// Coulomb friction of obstacles within a step of implicit Euler. Internal to dynamics/.
#pragma once

#include "dynamics/integrators/constrained_directions.h"

#include <span>

namespace sprung {

/// Friction on one particle. The load on a contact is known only after the linear system was solved, so friction is found by
/// repeated solves, each with what the last one showed (an active set): a particle that sticks is constrained in all directions,
/// one that slips feels kinetic friction of the load that it had.
class ImplicitFriction {
 public:
  /// Begins the step's friction. Contact pushed the particle by `push` [m], with friction of its own mass; it slipped by `slip` [m]
  /// along the surface. `impulse` [N s] is that of the push.
  void begin(const Matrix3& normals, const Vector3& push, const Vector3& slip, const Vector3& impulse);

  [[nodiscard]] bool begun() const { return state_ != State::none; }
  [[nodiscard]] bool sticks() const { return state_ == State::sticks; }
  [[nodiscard]] bool leaves() const { return state_ == State::leaves; }
  [[nodiscard]] const Vector3& impulse() const { return impulse_; }  ///< of friction on a particle that slips [N s]

  /// The change of that impulse with the slip, minus [N s/m]: friction follows the direction of slip. Without it, friction on stiff
  /// bodies that hardly slip would not settle.
  [[nodiscard]] const Matrix3& stiffness() const { return stiffness_; }

  /// Chooses what the next solve assumes, after one that made contact give `impulse` [N s] and left the particle with this slip
  /// [m]. Returns whether that differs from what the solve assumed.
  bool update(std::span<const Support> supports, const Matrix3& normals, const Vector3& impulse, const Vector3& slip);

 private:
  void set_impulse(const Matrix3& normals, const Vector3& impulse, const Vector3& slip);

  enum class State : char { none, slips, sticks, leaves };

  State state_ = State::none;
  int returns_ = 0;  ///< number of times that slipping ended in this step
  Vector3 impulse_ = Vector3::Zero();
  Matrix3 stiffness_ = Matrix3::Zero();
};

}  // namespace sprung
