// Builds particles, springs and pins from a body of a scene.
#pragma once

#include "network/network_builder.h"
#include "scene/building/mesh_finder.h"
#include "scene/format/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace sprung {

/// The particles and springs of the body at time 0, with their masses. Adds all problems; none if there are any.
[[nodiscard]] std::optional<BodyShape> build_body(const Scene& scene, const BodyScene& body, const MeshFinder& finder,
                                                  std::vector<Problem>& problems);

/// Particles that rest or move together; counted from 0 within the body.
struct ResolvedPin {
  std::vector<Index> particles;  ///< ascending, each once
  Motion motion;
};

/// The particles of the body's pins. Pins that rest are merged into one. Adds a problem for each pin that contains no particle,
/// names a particle that does not exist, or contains a particle that another pin moves.
[[nodiscard]] std::vector<ResolvedPin> resolve_pins(const Scene& scene, const BodyScene& body, const BodyShape& placed,
                                                    std::vector<Problem>& problems);

/// The pose of a placement, without its scale.
[[nodiscard]] RigidTransform pose_of(const Placement& placement);

}  // namespace sprung
