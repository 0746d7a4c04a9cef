// Resistance to bending of triangle meshes. Internal to network/.
#pragma once

#include "network/bodies/body_shape.h"

#include <vector>

namespace sprung {

/// Gives `shape` hinges at the edges between two triangles of its surface, and an element to each triangle that has one. Rest
/// angles are those of the mesh. `materials[t]` is that of triangle t, with the flexural rigidity D [N m] as modulus; null: no
/// element.
///
/// The curvature of a triangle is that of the quadratic surface through its corners and the far corners of its neighbours, which
/// are unfolded into its plane: exact for any triangulation. Where these corners hardly determine it, the average of the two
/// normals at each edge takes over (Grinspun, Gingold, Reisman and Zorin 2006). So a sheet has the rigidity D, without Poisson's
/// effect, in all directions and within a fifth on all triangulations. Edges of one triangle, or of more than two, transfer no
/// moment.
void add_triangle_bends(const std::vector<const SpringMaterial*>& materials, BodyShape& shape);

}  // namespace sprung
