// Meshes of tetrahedra, as meshing programs write them.
#pragma once

#include "base/types.h"

#include <array>
#include <filesystem>
#include <vector>

namespace sprung {

struct TetrahedraMesh {
  Points vertices;                               ///< positions [m], 3 x n
  std::vector<std::array<Index, 4>> tetrahedra;  ///< vertex indices; their `tetrahedron_volume` is positive
};

/// Signed volume [m^3]: positive if b - a, c - a, d - a, from the corners a, b, c, d, are a right-handed system.
[[nodiscard]] double tetrahedron_volume(const Eigen::Ref<const Points>& vertices, const std::array<Index, 4>& corners);

/// A side of a tetrahedron.
struct TetrahedronSide {
  std::array<Index, 3> corners{};  ///< counter-clockwise seen from outside
  std::array<Index, 3> sorted{};   ///< its corners, ascending
  Index tetrahedron = 0;
};

/// The sides of all tetrahedra, sorted by `sorted`, then by tetrahedron.
[[nodiscard]] std::vector<TetrahedronSide> tetrahedron_sides(const std::vector<std::array<Index, 4>>& tetrahedra);

/// The sides that belong to one tetrahedron alone, in the order of the tetrahedra.
[[nodiscard]] Triangles boundary_triangles(const std::vector<std::array<Index, 4>>& tetrahedra);

/// Whether read_tetrahedra() reads files with this extension.
[[nodiscard]] bool is_tetrahedra_file(const std::filesystem::path& file);

/// Reads the tetrahedra of a file: Gmsh `.msh` 2.2 and 4.1 and VTK legacy `.vtk`, both as text, and TetGen's `.node` and `.ele`,
/// of which either may be named; the other lies beside it.
///
/// Vertices keep the order of the file; those without a tetrahedron are left out. Points, edges and faces of the file are ignored.
/// Tetrahedra of negative volume are turned. Throws InputError that names, by line, all problems of a file: malformed or
/// non-finite numbers, counts that do not fit, nodes that are missing or numbered twice, other cells than tetrahedra of four
/// corners, tetrahedra without volume, and tetrahedra that share a side on the same side of it.
[[nodiscard]] TetrahedraMesh read_tetrahedra(const std::filesystem::path& file);

}  // namespace sprung
