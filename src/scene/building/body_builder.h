// Builds particles, springs and pins from a body of a scene.
#pragma once

#include "geometry/obj_source/obj_source.h"
#include "network/network_builder.h"
#include "scene/building/mesh_finder.h"
#include "scene/format/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace sprung {

struct BuiltBody {
  BodyShape shape;                    ///< particles and springs at time 0, with their masses
  std::optional<ObjSource> source{};  ///< of a mesh
};

/// Adds all problems; none if there are any.
[[nodiscard]] std::optional<BuiltBody> build_body(const Scene& scene, const BodyScene& body, const MeshFinder& finder,
                                                  std::vector<Problem>& problems);

/// Particles that rest or move together; counted from 0 within the body.
struct ResolvedPin {
  std::vector<Index> particles;  ///< ascending, each once
  Motion motion;
};

/// The particles of the body's pins. Indices count the vertices of a mesh's file. Pins that rest are merged into one. Adds a problem
/// for each pin that contains no particle, names a particle that does not exist, or contains a particle that another pin moves.
[[nodiscard]] std::vector<ResolvedPin> resolve_pins(const Scene& scene, const BodyScene& body, const BuiltBody& placed,
                                                    std::vector<Problem>& problems);

/// The pose of a placement, without its scale.
[[nodiscard]] RigidTransform pose_of(const Placement& placement);

}  // namespace sprung
