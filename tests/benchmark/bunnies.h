// The Stanford bunny at several resolutions: closed, oriented outward, 1 m in its largest extent, around the origin.
#pragma once

#include "geometry/mesh/triangle_mesh.h"

namespace sprung::benchmarks {

/// About so many triangles. Up to 69,000 they come from collapsing edges of Debian's bunny (Lindstrom and Turk 1998, by CGAL),
/// beyond that from cutting each triangle of the bunny of a fourth of them into four. Made once for each number. Throws InputError
/// when the bunny is not installed.
[[nodiscard]] const TriangleMesh& bunny(Index triangles);

}  // namespace sprung::benchmarks
