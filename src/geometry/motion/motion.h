// Prescribed rigid motion of obstacles and of pinned particles.
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

/// A pose at a time, which a program gave.
struct TimedPose {
  double time = 0.0;  ///< [s]
  RigidTransform pose = RigidTransform::Identity();

  [[nodiscard]] bool operator==(const TimedPose& other) const { return time == other.time && pose.matrix() == other.pose.matrix(); }
};

enum class Interpolation : std::uint8_t { linear, smooth };

/// Keyframes and a spin. The components of keyframes are interpolated linearly or smoothly, and constant outside their range. The
/// spin turns without end and is applied after the keyframes. Default: no motion.
struct Motion {
  std::vector<Keyframe> keyframes{};                    ///< times strictly increasing
  Interpolation interpolation = Interpolation::linear;  ///< smooth: 3 s^2 - 2 s^3 between two keyframes
  Vector3 spin = Vector3::Zero();                       ///< angular velocity vector [degrees/s] about the placed origin
  /// Instead of the placed pose and all else, if there are any; times strictly increasing. Between two of them the position moves
  /// on a line and the rotation on the shortest arc (slerp: Shoemake 1985). At their times poses are exact.
  std::vector<TimedPose> poses{};

  /// False if the pose is the same at all times.
  [[nodiscard]] bool moves() const;

  /// The time from which on the pose stays the same [s]; infinity with a spin, 0 without motion.
  [[nodiscard]] double end() const;

  /// Upper bound of the angle turned between two times, forth and back added [degrees].
  [[nodiscard]] double rotation(double begin, double end) const;

  /// The pose at `time` [s] of an object that is placed at `placed`.
  [[nodiscard]] RigidTransform pose(const RigidTransform& placed, double time) const;
};

}  // namespace sprung
