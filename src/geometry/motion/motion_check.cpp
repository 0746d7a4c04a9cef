#include "geometry/motion/motion_check.h"

#include "base/format.h"

#include <cmath>

namespace sprung {

void check_motion(const std::string& key, const Motion& motion, ProblemList& problems) {
  problems.require_each(
      motion.keyframes.size(),
      [&](std::size_t k) {
        const Keyframe& frame = motion.keyframes[k];
        return std::isfinite(frame.time) && frame.position.allFinite() && frame.rotation.allFinite();
      },
      [&](std::size_t k) { return "time " + format_number(motion.keyframes[k].time); },
      EntryRule{key + ".keyframes", "must be finite numbers", "give times in s, positions in m and rotations in degrees"});
  problems.require_each(
      motion.keyframes.size(), [&](std::size_t k) { return k == 0 || !(motion.keyframes[k].time <= motion.keyframes[k - 1].time); },
      [&](std::size_t k) { return "time " + format_number(motion.keyframes[k].time); },
      EntryRule{key + ".keyframes", "must be later than the keyframe before it", "sort the keyframes by time"});
  if (!motion.spin.allFinite()) problems.add(key + ".spin", vector_text(motion.spin), "must be finite", "give degrees per second");
}

bool is_rigid(const RigidTransform& pose) {
  constexpr double kRounding = 1.0e-9;
  const Matrix3 linear = pose.linear();
  return pose.matrix().allFinite() && linear.isUnitary(kRounding) && linear.determinant() > 0.0;
}

void check_pose(const std::string& key, const RigidTransform& pose, ProblemList& problems) {
  if (is_rigid(pose)) return;
  if (!pose.matrix().allFinite()) {
    problems.add(key, pose.linear().allFinite() ? vector_text(pose.translation()) : "a rotation that is not finite",
                 "must be finite", "give a position in m and a rotation");
    return;
  }
  const Matrix3 linear = pose.linear();
  const double off = (linear.transpose() * linear - Matrix3::Identity()).norm();
  problems.add(key, linear.determinant() < 0.0 ? "a reflection" : "a matrix R with |R^T R - I| = " + format_number(off, 3),
               "must be a rotation and a translation",
               "leave out scale, shear and reflection; the normalized quaternion of R gives a rotation");
}

}  // namespace sprung
