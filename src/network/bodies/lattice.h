// The regular grid of particles under cloths and solids. Internal to network/.
#pragma once

#include "network/bodies/body_shape.h"

#include <array>
#include <vector>

namespace sprung {

/// A centred grid; x runs fastest, then y, then z. A cloth is a grid of resolution 1 and size 1 along z.
struct Lattice {
  Vector3 size = Vector3::Ones();  ///< [m]
  std::array<Index, 3> resolution{1, 1, 1};

  using Node = std::array<Index, 3>;
  [[nodiscard]] Index number(const Node& node) const { return node[0] + resolution[0] * (node[1] + resolution[1] * node[2]); }
  [[nodiscard]] std::vector<Vector3> positions() const;

  /// Distances of neighbours [m]; the size along an axis of resolution 1.
  [[nodiscard]] Vector3 spacing() const;

  /// The volume [m^3] (cloth: area [m^2]) nearest to each node: that of a cell, halved for each border that the node lies on.
  [[nodiscard]] std::vector<double> measures() const;
};

/// The cells between the nodes of a solid.
[[nodiscard]] Cells lattice_cells(const Lattice& lattice);

/// Structural springs along the axes, shear springs along face and space diagonals, bend springs along the axes, skipping one
/// node.
void add_lattice_springs(const Lattice& lattice, const SpringMaterials& materials, Springs& springs);

/// Angle bends along the x axis and the y axis of a cloth.
void add_lattice_angle_bends(const Lattice& lattice, const SpringMaterial& material, AngleBends& bends);

/// Appends two triangles for each cell in the layer of nodes with index `layer` along `axis`. They face along the axis if `along`
/// is true, otherwise against it. The diagonals alternate from cell to cell.
void add_layer_triangles(const Lattice& lattice, int axis, Index layer, bool along, std::vector<std::array<Index, 3>>& triangles);

[[nodiscard]] Triangles to_triangles(const std::vector<std::array<Index, 3>>& triangles);

}  // namespace sprung
