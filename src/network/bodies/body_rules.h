// Rules that apply to all kinds of bodies. Internal to network/.
#pragma once

#include "base/problem_list.h"
#include "network/bodies/body_shape.h"

#include <string>

namespace sprung {

/// Adds a problem for a particle count beyond kMaxBodyParticles.
void require_affordable(const std::string& key, const std::string& value, double particles, ProblemList& problems);

/// Adds a problem if the materials request angle bends, which `body`, such as `a solid`, does not support.
void refuse_angle_bends(const SpringMaterials& materials, const std::string& body, ProblemList& problems);

/// Adds the problems of stiffness, modulus and damping of all kinds of springs.
void require_materials(const SpringMaterials& materials, ProblemList& problems);

}  // namespace sprung
