// Prescribed rigid motion: of obstacles, and of pinned particles.
#pragma once

#include "base/types.h"

#include <vector>

namespace sprung {

/// Rotation by angles [degrees] about the fixed axes x, then y, then z; exact for multiples of 90.
[[nodiscard]] Matrix3 rotation_from_degrees(const Vector3& degrees);

struct Keyframe {
  double time = 0.0;                   ///< [s]
  Vector3 position = Vector3::Zero();  ///< added to the placed position [m]
  Vector3 rotation = Vector3::Zero();  ///< [degrees], about the placed origin, after the placed rotation
};

enum class Interpolation : std::uint8_t { linear, smooth };

/// Keyframes, whose components interpolate linearly or smoothly and hold outside their range, and a spin that turns for ever
/// after them. Default: no motion.
struct Motion {
  std::vector<Keyframe> keyframes{};                    ///< times strictly increasing
  Interpolation interpolation = Interpolation::linear;  ///< smooth: 3 s^2 - 2 s^3 between two keyframes
  Vector3 spin = Vector3::Zero();                       ///< angular velocity vector [degrees/s], through the placed origin

  /// False when the pose is the same at all times.
  [[nodiscard]] bool moves() const;

  /// The most by which it turns, there and back, between two times [degrees].
  [[nodiscard]] double turn(double begin, double end) const;

  /// Where a thing placed at `placed` is at `time` [s].
  [[nodiscard]] RigidTransform pose(const RigidTransform& placed, double time) const;
};

}  // namespace sprung
