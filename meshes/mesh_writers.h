// The bytes of the formats that the generated environments are in. The library reads them through assimp and writes OBJ only.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

#include <string>

namespace sprung::meshes {

/// Binary STL.
[[nodiscard]] std::string stl_bytes(const TriangleMesh& mesh);

/// ASCII STL.
[[nodiscard]] std::string stl_text(const TriangleMesh& mesh);

/// Binary little-endian PLY.
[[nodiscard]] std::string ply_bytes(const TriangleMesh& mesh);

/// ASCII PLY.
[[nodiscard]] std::string ply_text(const TriangleMesh& mesh);

[[nodiscard]] std::string off_text(const TriangleMesh& mesh);

/// A glTF node's place: scale, then rotation (unit quaternion x, y, z, w), then translation [m].
struct Place {
  std::string scale;
  std::string rotation;
  std::string translation;
};

/// glTF 2.0 with the buffer inside, the mesh in a node at `inner` that is the child of a node at `outer`.
/// Requires at most 65,536 vertices.
[[nodiscard]] std::string gltf_text(const TriangleMesh& mesh, const Place& outer, const Place& inner);

/// The binary container of glTF 2.0: the JSON text, then the buffer without `uri`, if it is not empty.
[[nodiscard]] std::string glb_bytes(std::string json, std::string buffer = "");

/// 3DS, whose files have Z up: one object without a material, in a node of its own. Requires at most 65,535 vertices and faces.
[[nodiscard]] std::string three_ds_bytes(const TriangleMesh& mesh);

}  // namespace sprung::meshes
