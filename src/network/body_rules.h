// The rules that all ways to make a body share. Internal to network/.
#pragma once

#include "base/problem_list.h"
#include "network/body_shape.h"

#include <string>

namespace sprung {

/// Adds a problem for a particle count beyond kMaxBodyParticles.
void require_affordable(const std::string& key, const std::string& value, double particles, ProblemList& problems);

/// Adds a problem when the materials ask for angle bends, which `body`, such as `a solid`, does not have.
void refuse_angle_bends(const SpringMaterials& materials, const std::string& body, ProblemList& problems);

/// Adds the problems of stiffness, modulus and damping of all kinds.
void require_materials(const SpringMaterials& materials, ProblemList& problems);

}  // namespace sprung
