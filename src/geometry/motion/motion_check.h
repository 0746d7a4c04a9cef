// The rules for a prescribed motion.
#pragma once

#include "base/problem_list.h"
#include "geometry/motion/motion.h"

#include <string>

namespace sprung {

/// Adds the problems of a motion: keyframes or a spin that are not finite, and keyframes that are not later than the previous one.
/// `key` is the prefix of the keys, such as `pins[0].motion`.
void check_motion(const std::string& key, const Motion& motion, ProblemList& problems);

/// Whether a pose is finite, and a rotation and a translation but for rounding.
[[nodiscard]] bool is_rigid(const RigidTransform& pose);

/// Adds the problem of a pose that is not rigid. `key` is that of the pose, such as `pins.hand.pose`.
void check_pose(const std::string& key, const RigidTransform& pose, ProblemList& problems);

}  // namespace sprung
