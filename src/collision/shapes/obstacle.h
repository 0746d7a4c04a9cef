// Plain data of an obstacle: shape, motion, material.
#pragma once

#include "base/contact_material.h"
#include "geometry/mesh/mesh_sequence.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/motion/motion.h"

#include <memory>
#include <string>
#include <variant>

namespace sprung {

/// A triangle mesh from `import_mesh`. A closed mesh has an inside. An open mesh has two sides, and each particle stays on its
/// own.
struct MeshGeometry {
  std::shared_ptr<const TriangleMesh> mesh{};
  bool closed = false;
};

/// A deforming mesh from `import_sequence`. `closed` is the same for all frames.
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
};  ///< length between the centres of the caps
struct CylinderGeometry {
  double radius = 0.0;
  double height = 0.0;
};
struct ConeGeometry {
  double radius = 0.0;
  double height = 0.0;
};  ///< the tip is at +height / 2
struct EllipsoidGeometry {
  Vector3 radii = Vector3::Zero();
};
struct HalfSpaceGeometry {
  Vector3 normal = Vector3::UnitY();
  double offset = 0.0;
};  ///< solid where normal . x <= offset; unit normal

using ObstacleGeometry = std::variant<MeshGeometry, SequenceGeometry, SphereGeometry, BoxGeometry, CapsuleGeometry,
                                      CylinderGeometry, ConeGeometry, EllipsoidGeometry, HalfSpaceGeometry>;

/// Copies share the data of meshes and sequences, so they are cheap. Const members may be called from several threads at the same
/// time; deforms() compares the frames of a sequence until two differ.
struct Obstacle {
  std::string name{};
  ObstacleGeometry geometry{};                            ///< scale applied
  RigidTransform rest_pose = RigidTransform::Identity();  ///< pose without motion
  Motion motion{};
  ContactMaterial material{};

  /// Whether the shape changes with time.
  [[nodiscard]] bool deforms() const;
  /// Whether the surface changes with time: the obstacle moves or deforms.
  [[nodiscard]] bool changes() const { return motion.moves() || deforms(); }
};

/// Triangles of the surface at a time [s] in the obstacle's own frame, for export. Primitives are tessellated; a half-space is a
/// square of side 2 * `extent` [m]. The vertex indices are the same at all times. Makes a new mesh in each call. Thread-safe.
[[nodiscard]] TriangleMesh obstacle_mesh(const ObstacleGeometry& geometry, double extent, double time = 0.0);

}  // namespace sprung
