// What the environment consists of: a shape, its motion, its surface. Plain data; `environment.h` makes FCL geometries of it.
#pragma once

#include "base/contact_material.h"
#include "geometry/mesh/mesh_sequence.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/motion/motion.h"

#include <memory>
#include <string>
#include <variant>

namespace sprung {

/// A triangle mesh as `import_mesh` leaves it. Closed meshes have an inside; open ones keep each particle on its side.
struct MeshGeometry {
  std::shared_ptr<const TriangleMesh> mesh{};
  bool closed = false;
};

/// A mesh that deforms, as `import_sequence` leaves it. What closed means is judged once, for all frames.
struct SequenceGeometry {
  std::shared_ptr<const MeshSequence> sequence{};
  bool closed = false;
};

// Primitives are centred on their origin; capsule, cylinder and cone stand along y. All lengths [m], > 0.
struct SphereGeometry {
  double radius = 0.0;
};
struct BoxGeometry {
  Vector3 size = Vector3::Zero();
};
struct CapsuleGeometry {
  double radius = 0.0;
  double length = 0.0;
};  ///< length between the centres of its caps
struct CylinderGeometry {
  double radius = 0.0;
  double height = 0.0;
};
struct ConeGeometry {
  double radius = 0.0;
  double height = 0.0;
};  ///< its tip at +height / 2
struct EllipsoidGeometry {
  Vector3 radii = Vector3::Zero();
};
struct HalfSpaceGeometry {
  Vector3 normal = Vector3::UnitY();
  double offset = 0.0;
};  ///< solid where normal . x <= offset; unit normal

using ObstacleGeometry = std::variant<MeshGeometry, SequenceGeometry, SphereGeometry, BoxGeometry, CapsuleGeometry,
                                      CylinderGeometry, ConeGeometry, EllipsoidGeometry, HalfSpaceGeometry>;

struct Obstacle {
  std::string name{};
  ObstacleGeometry geometry{};  ///< scaled already
  RigidTransform placed = RigidTransform::Identity();
  Motion motion{};
  ContactMaterial material{};

  /// Whether its shape is not the same at all times.
  [[nodiscard]] bool deforms() const;
  /// Whether its surface is not the same at all times: it moves or deforms.
  [[nodiscard]] bool changes() const { return motion.moves() || deforms(); }
};

/// The obstacle's surface at a time [s] as triangles in its own frame, for export: a mesh as it is, a primitive tessellated, a
/// half-space, and it alone, as a square of side 2 * `extent` [m]. Vertices keep their numbers at all times.
[[nodiscard]] TriangleMesh obstacle_mesh(const ObstacleGeometry& geometry, double extent, double time = 0.0);

}  // namespace sprung
