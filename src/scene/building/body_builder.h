// Builds particles and springs from a body of a scene.
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

/// The particles and springs of a body. Adds the problems of its file, shape, groups and selectors. Nothing if they leave no body.
[[nodiscard]] std::optional<BuiltBody> build_body(const Scene& scene, const BodyScene& body, const MeshFinder& finder,
                                                  std::vector<Problem>& problems);

/// The pose of a placement, without its scale.
[[nodiscard]] RigidTransform pose_of(const Placement& placement);

}  // namespace sprung
