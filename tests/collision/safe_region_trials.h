// Random elements near meshes, random displacements within their safe regions, and exact crossing tests over all triangles.
#pragma once

#include "collision/mesh_bvh/mesh_bvh.h"
#include "collision/safe_regions/safe_region.h"
#include "collision/sample_meshes.h"

namespace sprung::test {

inline Box3 box_of(const ElementCorners& element) {
  Box3 box;
  for (int i = 0; i < element.count; ++i) box.extend(element.x[static_cast<std::size_t>(i)]);
  return box;
}

inline bool edge_crosses(const Vector3& a, const Vector3& b, const TriangleCorners& t) {
  return crossing_fraction(a, b, t[0], t[1], t[2], CrossingSides::both).has_value();
}

/// Whether an edge of element or mesh crosses the other. Tests all triangles with exact predicates.
inline bool crosses(const ElementCorners& element, const TriangleMesh& mesh) {
  const Box3 box = box_of(element);
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    TriangleCorners corners;
    Box3 around;
    for (int k = 0; k < 3; ++k) {
      corners[static_cast<std::size_t>(k)] = mesh.vertices.col(mesh.triangles(k, t));
      around.extend(corners[static_cast<std::size_t>(k)]);
    }
    if (!around.intersects(box)) continue;
    for (int i = 0; i + 1 < element.count || (element.count == 3 && i < 3); ++i) {
      if (edge_crosses(element.x[static_cast<std::size_t>(i)], element.x[static_cast<std::size_t>((i + 1) % element.count)],
                       corners)) {
        return true;
      }
    }
    for (std::size_t i = 0; element.count == 3 && i < 3; ++i) {
      if (edge_crosses(corners[i], corners[(i + 1) % 3], element.x)) return true;
    }
  }
  return false;
}

inline bool contains(const SafeRegion& region, const Vector3& corner, const Vector3& p) {
  // Rounding of coordinates up to 2 m, far below the clearance of the region.
  constexpr double kRounding = 1e-15;
  if ((p - corner).norm() > region.free_radius) return false;
  if (!Box3(region.box.min().array() - kRounding, region.box.max().array() + kRounding).contains(p)) return false;
  for (int k = 0; k < region.plane_count; ++k) {
    const HalfSpace& plane = region.planes[static_cast<std::size_t>(k)];
    if (plane.normal.dot(p) < plane.offset - kRounding) return false;
  }
  return true;
}

inline ElementCorners random_element(const TriangleMesh& mesh, Random& random, int corners, double size, double height) {
  ElementCorners element{.count = corners};
  const Vector3 middle = test::near_surface(mesh, random, random.between(0.0, height));
  for (int i = 0; i < corners; ++i) {
    element.x[static_cast<std::size_t>(i)] = middle + random.between(0.2, 1.0) * size * random.direction();
  }
  return element;
}

/// A displaced corner close to the border of its region: a random displacement, shortened until it ends inside.
inline Vector3 moved_within(const SafeRegion& region, const Vector3& corner, double reach, Random& random) {
  Vector3 step = random.between(0.5, 3.0) * reach * random.direction();
  for (int halving = 0; halving < 60; ++halving, step *= 0.8) {
    if (contains(region, corner, corner + step)) return corner + step;
  }
  return corner;
}

}  // namespace sprung::test
