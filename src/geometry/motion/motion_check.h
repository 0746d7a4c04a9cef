// The rules that a prescribed motion must keep.
#pragma once

#include "base/problem_list.h"
#include "geometry/motion/motion.h"

#include <string>

namespace sprung {

/// Adds what is wrong with a motion: keyframes or a spin that are not finite, keyframes that are not later than the one before;
/// `key` is the start of the keys, such as `pins[0].motion`.
void check_motion(const std::string& key, const Motion& motion, ProblemList& problems);

}  // namespace sprung
