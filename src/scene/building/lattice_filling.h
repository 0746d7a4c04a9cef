// Fills closed meshes with the cells of a lattice.
#pragma once

#include "network/bodies/body_shape.h"

namespace sprung {

/// The cells of `cell_size` [m] that lie within a closed surface or hold a vertex of it. For contact, edges of the surface that
/// are longer than a cell are divided. The fraction of a cell within the surface is that of 27 points, and at least a quarter.
/// Throws InputError (keys `file`, `cell_size`) unless the surface is closed and there are at most 1024 cells along a side, and if
/// the particles would not fit the memory of this machine.
[[nodiscard]] LatticeShape fill_with_cells(PolygonMesh surface, double cell_size);

}  // namespace sprung
