// From a body of a scene to particles, springs and pins.
#pragma once

#include "network/network_builder.h"
#include "scene/building/mesh_finder.h"
#include "scene/format/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace sprung {

/// The body's particles and springs where they are at time 0, with their masses. Adds every problem; none when there are any.
[[nodiscard]] std::optional<BodyShape> build_body(const Scene& scene, const BodyScene& body, const MeshFinder& finder,
                                                  std::vector<Problem>& problems);

/// Particles that move, or stay, together; counted from 0 within the body.
struct ResolvedPin {
  std::vector<Index> particles;  ///< ascending, each once
  Motion motion;
};

/// The particles that the body's pins hold. Pins that stay where they are become one. Adds a problem for each that holds none,
/// names a particle that is not there, or holds a particle that another moves.
[[nodiscard]] std::vector<ResolvedPin> resolve_pins(const Scene& scene, const BodyScene& body, const BodyShape& placed,
                                                    std::vector<Problem>& problems);

/// The placed pose without its scale.
[[nodiscard]] RigidTransform pose_of(const Placement& place);

}  // namespace sprung
