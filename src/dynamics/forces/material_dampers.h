// The dampers of materials as forces of their own, so that explicit schemes can apply them in several passes a step: see
// damper_passes.h.
#pragma once

#include "dynamics/forces/element_constants.h"
#include "dynamics/forces/force.h"
#include "network/model/spring_network.h"

namespace sprung {

/// Whether a kind of springs of the body, or of any body, has dampers of a material: see Body::has_material_dampers.
[[nodiscard]] bool has_material_dampers(const Body& body);
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

/// Whether the dampers of the body's face bends may bound its step: their largest rate exceeds a tenth of 1 / dt in the longest
/// step dt that its springs alone allow.
[[nodiscard]] bool face_bends_damp_fast(const SpringNetwork& network, const Body& body);

/// Calls `function(e)` for each angle bend and face bend with a damper of a material, numbered as in `constants_of_bends`. Leaves
/// out face bends that do not damp fast. They are the most expensive dampers, and act once a step with the other forces.
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

/// The dampers of materials alone. `most` [1/s] bounds the rate at which they damp any mode. Dampers at particles whose sum of
/// damping could exceed it are weakened in proportion. All others have the damping of the network. Keeps a reference to the
/// network. Call hold() before add().
[[nodiscard]] Forces material_dampers(const SpringNetwork& network, double most);

}  // namespace sprung
