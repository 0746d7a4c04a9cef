// The Stanford bunny at several resolutions: closed, oriented outward, 1 m in its largest extent, around the origin.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

namespace sprung::benchmarks {

/// The bunny with about `triangles` triangles. Up to 69,000 the edges of Debian's bunny are collapsed (Lindstrom and Turk 1998, by
/// CGAL); beyond that each triangle of the bunny with a quarter of them is divided into four. Each mesh is built once. Throws
/// InputError if the bunny is not installed.
[[nodiscard]] const TriangleMesh& bunny(Index triangles);

}  // namespace sprung::benchmarks
