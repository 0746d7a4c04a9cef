// How the edges of tetrahedra share a solid. Internal to network/.
//
// An edge is a spring of stiffness k = 6 E V_e / L^2. V_e is the part of the volume that the edge stands for: the sum of a sixth of
// the volume of each tetrahedron around it. Averaged over the directions of a strain, the springs then have the energy of a solid
// of Young's modulus E and Poisson's ratio 1/4, the only one that springs between pairs of particles can have (Cauchy). For regular
// tetrahedra this is k = 0.118 E L; Lloyd, Szekely and Harders (2007) find 0.113 E L.
//
// Two things keep a bar of these springs from pulling as one of the solid: the edges of a mesh may have few directions, and the
// particles of an irregular network move so that it gives way. Two factors of V_e correct them.
//
// Direction. With unit vectors n along the edges, the springs are isotropic if the mean of n (x) n (x) n (x) n, weighted by V_e, is
// that over all directions. The factor 1 + G : n (x) n (x) n (x) n, with a symmetric G of 15 numbers, brings the mean as near to it
// as it may without large changes of V_e (least squares; kEvenness weighs the changes). It is the same for all edges of one
// direction.
//
// Relaxation. Under an even strain the forces on an inner particle do not cancel unless the edges around it are symmetric. If it
// alone follows its force f, it releases the energy f K^-1 f / 2. The sum over the particles, relative to the energy of the strain,
// is by what the springs are too soft.
//
// Pulled bars, 4 x 1 x 1 with clamped ends and 1, 2 and 4 cubes across, relative to E A / L. In brackets: without the two factors.
//
//   cubes cut into five                            1.04, 1.07, 1.07   (1.15, 1.19, 1.19)
//   into six around one diagonal                   1.08, 1.02, 0.99   (1.20, 1.14, 1.11)
//   into six, mirrored from cube to cube           0.75, 1.08, 1.09   (1.04, 1.33, 1.33)
//   into five, vertices moved by 0.2 sides         1.03, 1.04, 1.06   (1.13, 1.12, 1.10)
//   into six, vertices moved by 0.1 sides          1.07, 0.97, 1.00
//   into six, vertices moved by 0.2 sides          1.06, 0.89, 0.96   (1.20, 1.07, 0.97)
//   Delaunay, of random points                     1.00, 1.00         (0.96, 0.95)
//   TetGen -q1.4, of 166, 591 and 780 vertices     0.89, 0.96, 0.95   (0.79, 0.89, 0.90)
//
// Cells twice or three times as long along the bar as across have too few edges in the other directions: cut into five 2.2, into
// six 0.9 to 1.2.
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
