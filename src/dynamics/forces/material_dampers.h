// The dampers of materials as forces of their own, so that explicit schemes can take them in shorter steps than the springs.
#pragma once

#include "dynamics/forces/element_constants.h"
#include "dynamics/forces/force.h"
#include "network/model/spring_network.h"

namespace sprung {

/// Whether a body has dampers of a material: see Body::has_material_dampers.
[[nodiscard]] bool has_material_dampers(const SpringNetwork& network);

/// Calls `function(s)` for each spring with a damper of a material.
template <class Function>
void for_material_springs(const SpringNetwork& network, const Function& function) {
  for (const Body& body : network.bodies) {
    for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
      if (body.has_material_dampers[static_cast<std::size_t>(network.springs.kind[s])]) function(s);
    }
  }
}

/// Whether dampers of the body's face bends may bound its step: whether, in the longest step that its springs allow, a damper takes
/// more than a tenth of a velocity.
[[nodiscard]] bool face_bends_damp_fast(const SpringNetwork& network, const Body& body);

/// Calls `function(e)` for each angle bend and face bend with a damper of a material, numbered as in `constants_of_bends`. Face
/// bends that do not damp fast count as without one: they cost most, and as part of the other forces they act once a step.
template <class Function>
void for_material_bends(const SpringNetwork& network, const Function& function) {
  for (const Body& body : network.bodies) {
    if (!body.has_material_dampers[static_cast<std::size_t>(SpringKind::bend)]) continue;
    for (Index a = body.first_angle_bend; a < body.first_angle_bend + body.angle_bend_count; ++a) function(a);
    if (!face_bends_damp_fast(network, body)) continue;
    const Index first = network.angle_bends.count() + body.first_face_bend;
    for (Index e = first; e < first + body.face_bend_count; ++e) function(e);
  }
}

/// The constants of springs, and those of angle bends and face bends, without the dampers of materials.
[[nodiscard]] ElementConstants springs_without_material_dampers(const SpringNetwork& network);
[[nodiscard]] ElementConstants bends_without_material_dampers(const SpringNetwork& network);

/// The dampers of materials alone. `most` [1/s] bounds the rate at which they damp any mode: dampers at particles where the sum of
/// all could exceed it are weaker, in proportion, and all others are what the network gives.
[[nodiscard]] Forces material_dampers(const SpringNetwork& network, double most);

}  // namespace sprung
