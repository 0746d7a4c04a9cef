// A triangle mesh: positions and indices, nothing else.
#pragma once

#include "base/types.h"

namespace sprung {

struct TriangleMesh {
  Points vertices;      ///< positions [m], 3 x n
  Triangles triangles;  ///< vertex indices, 3 x m
};

/// Smallest axis-aligned box around the points [m]; empty for no points.
[[nodiscard]] Box3 bounds(const Points& points);

/// (b - a) x (c - a): twice the area [m^2], along the normal.
[[nodiscard]] Vector3 area_normal(const TriangleMesh& mesh, Index triangle);
[[nodiscard]] Vector3 area_normal(const Vector3& a, const Vector3& b, const Vector3& c);

/// Enclosed volume [m^3] by the divergence theorem. Requires a closed mesh; negative if its faces point inwards.
[[nodiscard]] double signed_volume(const TriangleMesh& mesh);
[[nodiscard]] double signed_volume(const Eigen::Ref<const Points>& vertices, const Triangles& triangles);

/// Adds `factor` times the derivatives of that volume by the vertices [m^2] to `sums`, 3 x n. Requires a closed mesh.
void add_volume_gradients(const Eigen::Ref<const Points>& vertices, const Triangles& triangles, double factor,
                          Eigen::Ref<Points> sums);

}  // namespace sprung
