// What a recorded run consists of: what stays the same, and one frame.
#pragma once

#include "geometry/mesh/polygon_mesh.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/obj_source/obj_source.h"
#include "network/model/attachment.h"
#include "network/model/springs.h"

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace sprung {

/// A body. Its vertices are those of its frames, in their order: of a welded mesh, several may be the same particle; of a lattice,
/// they are fewer than its particles.
struct RecordedBody {
  std::string name;
  std::string material{};  ///< name of its preset, such as `cotton`; empty: none
  Index first_particle = 0;
  Index particle_count = 0;
  std::vector<Index> particle_of;             ///< the particle of each vertex, counted over all bodies
  PolygonFaces faces;                         ///< of the vertices, with UVs and groups
  Edges lines{2, 0};                          ///< of the vertices
  std::vector<std::string> face_materials{};  ///< names as the OBJ file gives them to its faces (`usemtl`)
  std::vector<Index> face_material_begin{};   ///< the first face of each of these

  /// Its file; null for bodies without one, and in records of versions before 0.2. Read from a record, it has the texts of its
  /// `mtllib` files, and of textures their places alone.
  std::shared_ptr<const ObjSource> source{};
};

struct RecordedSprings {
  Edges ends{2, 0};                    ///< particles, counted over all bodies
  std::vector<double> rest_lengths{};  ///< at time 0 [m]
  std::vector<SpringKind> kinds{};
  std::vector<double> stiffness{};  ///< [N/m]; empty in records of versions before 0.2
  std::vector<double> damping{};    ///< [N s/m]; likewise
};

struct RecordedPin {
  std::string name;
  std::vector<Index> particles;                            ///< counted over all bodies
  Index obstacle = kNone;                                  ///< that it follows; kNone: none
  double from = 0.0;                                       ///< [s]
  double until = std::numeric_limits<double>::infinity();  ///< [s]
};

enum class ObstacleMotion : std::uint8_t { fixed, rigid, deforming };
inline constexpr std::array<const char*, 3> kObstacleMotionNames{"fixed", "rigid", "deforming"};  ///< in this order

struct RecordedObstacle {
  std::string name;
  ObstacleMotion motion = ObstacleMotion::fixed;
  TriangleMesh mesh;  ///< [m], in the world's frame if it is fixed, else in its own; a half-space is a square
};

struct RecordedModel {
  Index particle_count = 0;
  std::vector<RecordedBody> bodies;
  RecordedSprings springs;
  std::vector<RecordedPin> pins;
  std::vector<Attachment> attachments;
  std::vector<RecordedObstacle> obstacles;
};

/// Names of the materials of bodies, by the names of the bodies.
using BodyMaterials = std::map<std::string, std::string>;

/// Bits of the state of a particle.
inline constexpr std::uint8_t kInContact = 1;  ///< contact pushed it in the last step
inline constexpr std::uint8_t kPinned = 2;

struct RecordedFrame {
  double time = 0.0;                    ///< [s]
  Points positions{3, 0};               ///< of the particles [m]
  Points velocities{3, 0};              ///< of the particles [m/s]; 3 x 0 if they are not known
  std::vector<std::uint8_t> states{};   ///< of the particles, bits as above
  std::vector<char> broken{};           ///< by spring, whether it has broken; empty: none has
  std::vector<RigidTransform> poses{};  ///< of each obstacle's mesh in the world [m]; the identity if it is fixed
  std::vector<Points> deformed{};       ///< vertices of the obstacles that deform, in their frame [m]
};

/// The vertices of a body in a frame [m], 3 x n.
[[nodiscard]] inline Points vertices_of(const RecordedBody& body, const RecordedFrame& frame) {
  return frame.positions(Eigen::all, body.particle_of);
}

}  // namespace sprung
