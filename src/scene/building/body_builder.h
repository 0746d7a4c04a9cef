// Builds particles, springs and pins from a body of a scene.
#pragma once

#include "geometry/import/obj_groups.h"
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
  ObjGroups groups{};                 ///< of a mesh, if a selector or springs name one; with the vertices of the file
};

/// Adds all problems; none if there are any.
[[nodiscard]] std::optional<BuiltBody> build_body(const Scene& scene, const BodyScene& body, const MeshFinder& finder,
                                                  std::vector<Problem>& problems);

/// The particles of the body's pins, counted from 0 within the body. Indices count the vertices of a mesh's file. A
/// particle of several pins that rest for ever belongs to the first of them; a pin that is left without particles is left out. Adds
/// a problem for each pin that contains no particle, names a particle or a group that does not exist, or contains a particle that
/// another pin holds at the same time. Requires that the scene has the obstacles that pins follow.
[[nodiscard]] std::vector<Pin> resolve_pins(const Scene& scene, const BodyScene& body, const BuiltBody& placed,
                                            std::vector<Problem>& problems);

/// The pose of a placement, without its scale.
[[nodiscard]] RigidTransform pose_of(const Placement& placement);

}  // namespace sprung
