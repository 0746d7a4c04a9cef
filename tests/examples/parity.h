// Inside or outside of a closed mesh by the parity of the triangles above a point, independent of all contact code.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace sprung::testing {

/// Counts triangles above points. Triangles wait in columns of a grid in the x-z plane; the sides of their edges are computed from
/// the lower to the higher vertex, so that a point on an edge or a vertex is given to exactly one of the triangles that share it.
class Parity {
 public:
  explicit Parity(const TriangleMesh& mesh) : mesh_(mesh), box_(bounds(mesh.vertices)), columns_(kSide * kSide) {
    for (Index t = 0; t < mesh.triangles.cols(); ++t) {
      Box3 box;
      for (const Index corner : mesh.triangles.col(t)) box.extend(mesh.vertices.col(corner));
      for (int i = cell(0, box.min()[0]); i <= cell(0, box.max()[0]); ++i) {
        for (int k = cell(2, box.min()[2]); k <= cell(2, box.max()[2]); ++k) columns_[i * kSide + k].push_back(t);
      }
    }
  }

  [[nodiscard]] bool inside(const Vector3& p) const {
    if (!box_.contains(p)) return false;
    int above = 0;
    for (const Index t : columns_[cell(0, p[0]) * kSide + cell(2, p[2])]) above += is_above(t, p) ? 1 : 0;
    return above % 2 == 1;
  }

 private:
  static constexpr int kSide = 256;

  [[nodiscard]] int cell(int axis, double value) const {
    const double part = (value - box_.min()[axis]) / (box_.max()[axis] - box_.min()[axis]);
    return std::clamp(static_cast<int>(part * kSide), 0, kSide - 1);
  }

  // Which side of the edge from a to b, seen from above, p lies on; never neither.
  [[nodiscard]] bool left_of(Index a, Index b, const Vector3& p) const {
    if (a > b) return !left_of(b, a, p);
    const Vector3 u = mesh_.vertices.col(a) - p;
    const Vector3 v = mesh_.vertices.col(b) - p;
    return u[0] * v[2] - u[2] * v[0] >= 0.0;
  }

  [[nodiscard]] bool is_above(Index t, const Vector3& p) const {
    const auto corners = mesh_.triangles.col(t);
    const bool side = left_of(corners[0], corners[1], p);
    if (left_of(corners[1], corners[2], p) != side || left_of(corners[2], corners[0], p) != side) return false;
    const Vector3 normal = area_normal(mesh_, t);
    return normal.dot(mesh_.vertices.col(corners[0]) - p) / normal[1] > 0.0;
  }

  const TriangleMesh& mesh_;
  Box3 box_;
  std::vector<std::vector<Index>> columns_;
};

}  // namespace sprung::testing
