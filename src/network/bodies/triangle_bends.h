// Resistance to bending of triangle meshes. Internal to network/.
#pragma once

#include "network/bodies/body_shape.h"

#include <vector>

namespace sprung {

/// Gives `shape` hinges at the edges between two triangles of its surface, and an element to each triangle that has one. Rest
/// angles are those of the mesh. `materials[t]` is that of triangle t, with the flexural rigidity D [N m] as modulus.
///
/// The curvature of a triangle is that of the quadratic surface through its corners and the far corners of its neighbours, which
/// are unfolded into its plane. For a quadratic surface this is exact. Where the corners do not determine the surface, the
/// curvature comes from the average of the two normals at each edge (Grinspun, Gingold, Reisman and Zorin 2006). A sheet has the
/// rigidity D in all directions, without Poisson's effect, within a fifth on all triangulations tested. Edges of one triangle, or
/// of more than two, transfer no moment.
void add_triangle_bends(const std::vector<const SpringMaterial*>& materials, BodyShape& shape);

}  // namespace sprung
