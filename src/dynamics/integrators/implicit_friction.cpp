#include "dynamics/integrators/implicit_friction.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace sprung {
namespace {

// Friction is settled when it changes by less than this fraction.
constexpr double kSettled = 1.0e-3;

// A particle that slipped and stuck again this often in a step sticks for the rest of it. Otherwise particles joined by stiff
// springs alternate, and a rope at rest on a drum creeps.
constexpr int kReturns = 4;

/// The largest friction impulses, by Coulomb's law.
struct FrictionLimits {
  bool loaded = false;  ///< whether any support pushes
  double at_rest = 0.0;
  double slipping = 0.0;
};

/// Distributes the impulse among the supports, whose normals are linearly independent.
FrictionLimits limits_of(std::span<const Support> supports, const Vector3& impulse) {
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> normals(3, supports.size());
  for (std::size_t k = 0; k < supports.size(); ++k) normals.col(static_cast<Eigen::Index>(k)) = supports[k].normal;
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> loads =
      (normals.transpose() * normals).ldlt().solve(normals.transpose() * impulse);
  FrictionLimits limits;
  for (std::size_t k = 0; k < supports.size(); ++k) {
    const double load = std::max(0.0, loads[static_cast<Eigen::Index>(k)]);
    limits.loaded = limits.loaded || load > 0.0;
    limits.at_rest += supports[k].static_friction * load;
    limits.slipping += supports[k].friction * load;
  }
  return limits;
}

}  // namespace

// A body at rest falls freely in the solve before contact, so that its push stands for its load, and shows whether it sticks.
void ImplicitFriction::begin(const Matrix3& normals, const Vector3& push, const Vector3& slip, const Vector3& impulse) {
  state_ = slip.norm() <= kSettled * (normals * push).norm() ? State::sticks : State::slips;
  set_impulse(normals, impulse - normals * impulse, slip);
}

bool ImplicitFriction::update(std::span<const Support> supports, const Matrix3& normals, const Vector3& impulse,
                              const Vector3& slip) {
  const FrictionLimits limits = limits_of(supports, impulse);
  const Vector3 former = impulse_;
  const State former_state = state_;
  if (!limits.loaded) {
    state_ = State::leaves;
    set_impulse(normals, Vector3::Zero(), slip);
    return state_ != former_state;
  }
  if (state_ == State::sticks) {
    const Vector3 friction = impulse - normals * impulse;
    const double length = friction.norm();
    if (length <= limits.at_rest || returns_ >= kReturns) return false;
    state_ = State::slips;
    set_impulse(normals, limits.slipping / length * friction, Vector3::Zero());
    return true;
  }
  const double length = slip.norm();
  state_ = former.dot(slip) > 0.0 ? State::sticks : State::slips;
  if (state_ == State::sticks) ++returns_;
  const bool has_friction = state_ == State::slips && length > 0.0;
  set_impulse(normals, has_friction ? Vector3(-limits.slipping / length * slip) : Vector3::Zero(), slip);
  return state_ != former_state || (impulse_ - former).norm() > kSettled * limits.slipping;
}

void ImplicitFriction::set_impulse(const Matrix3& normals, const Vector3& impulse, const Vector3& slip) {
  impulse_ = impulse;
  stiffness_.setZero();
  const double length = slip.norm();
  const Matrix3 across = Matrix3::Identity() - normals;
  // Supports that leave no direction leave a slip of rounding errors, along which the stiffness would be negative.
  if (!((across * slip).norm() > 0.5 * length)) return;
  const Vector3 along = slip / length;
  stiffness_ = impulse.norm() / length * (across - along * along.transpose());
}

}  // namespace sprung
