// How the edges of tetrahedra share a solid. Internal to network/.
//
// An edge is a spring of stiffness k = 6 E V_e / L^2. V_e is the part of the volume that the edge stands for: the sum of a sixth of
// the volume of each tetrahedron around it. Averaged over the directions of a strain, the springs then have the energy of a solid
// of Young's modulus E and Poisson's ratio 1/4, the only one that springs between pairs of particles can have (Cauchy). For regular
// tetrahedra this is k = 0.118 E L; Lloyd, Szekely and Harders (2007) find 0.113 E L.
//
// A bar of these springs still differs from a solid for two reasons. The edges of a mesh may have few directions. And the particles
// of an irregular network follow their forces, which makes the bar softer. V_e has a factor for each reason.
//
// Direction. With unit vectors n along the edges, the springs are isotropic if the mean of n (x) n (x) n (x) n, weighted by V_e, is
// that over all directions. The factor 1 + G : n (x) n (x) n (x) n, with a symmetric G of 15 numbers, brings the mean as near to it
// as it may without large changes of V_e (least squares; kEvenness weighs the changes). It is the same for all edges of one
// direction.
//
// Relaxation. Under an even strain the forces on an inner particle do not cancel unless the edges around it are symmetric. If it
// alone follows its force f, it releases the energy f K^-1 f / 2. The springs are too soft by the sum of these energies, relative
// to the energy of the strain.
//
// The README of network/ lists what bars pull with and without these factors.
#pragma once

#include "base/types.h"

#include <array>
#include <vector>

namespace sprung {

/// An edge of tetrahedra.
struct TetrahedraEdge {
  Index first = 0;  ///< the lower vertex
  Index second = 0;
  double volume = 0.0;  ///< [m^3] that it stands for
};

/// The edges, sorted by their vertices, with V_e and both factors in their volumes. Requires tetrahedra of positive volume.
[[nodiscard]] std::vector<TetrahedraEdge> tetrahedra_edges(const Points& vertices,
                                                           const std::vector<std::array<Index, 4>>& tetrahedra);

}  // namespace sprung
