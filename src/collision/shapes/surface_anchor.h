// Points that move with the surface of a deforming mesh.
#pragma once

#include "geometry/mesh/mesh_sequence.h"

#include <vector>

namespace sprung {

/// A point beside a triangle. It stays over the same place of the triangle, at the same height above it.
struct SurfaceAnchor {
  Index triangle = kNone;
  Vector3 weights = Vector3::Zero();  ///< of the corners, for the point of the triangle that was nearest
  Vector3 offset = Vector3::Zero();   ///< from there [m], in a frame that turns with the triangle
};

/// The triangles that are nearest to these points at a time [s]. Requires a valid sequence and finite points, in its frame.
[[nodiscard]] std::vector<Index> nearest_triangles(const MeshSequence& sequence, double time, const std::vector<Vector3>& points);

/// The anchor of a point at a time [s].
[[nodiscard]] SurfaceAnchor anchored(const MeshSequence& sequence, Index triangle, double time, const Vector3& point);

/// Where the anchor takes its point at a time [s].
[[nodiscard]] Vector3 anchored_position(const MeshSequence& sequence, const SurfaceAnchor& anchor, double time);

}  // namespace sprung
