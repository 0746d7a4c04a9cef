#include "network/bodies/lattice.h"

#include "network/bodies/shape_parts.h"

namespace sprung {
namespace {

using Direction = std::array<Index, 3>;

constexpr Direction kAxes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr Direction kDiagonals[] = {{1, 1, 0},  {-1, 1, 0}, {1, 0, 1},  {-1, 0, 1}, {0, 1, 1},
                                    {0, -1, 1}, {1, 1, 1},  {-1, 1, 1}, {1, -1, 1}, {-1, -1, 1}};

// Springs from each node to the one `stride` cells further along `direction`.
//
// Parallel springs share the body: in a cell of volume V (cloth: area), springs along a step s are V / |s| apart. On a border
// parallel to the step, a spring represents only half a cell. For example, the cross-sections of the structural springs through a
// cut across the x axis add up to that of the body: sum of (h_y h_z, halved at borders) = size_y size_z.
void add_family(const Lattice& lattice, const Direction& direction, Index stride, const SpringMaterial& material, SpringKind kind,
                Springs& springs) {
  const Vector3 spacing = lattice.spacing();
  const Vector3 step(spacing.x() * direction[0], spacing.y() * direction[1], spacing.z() * direction[2]);
  const double rest_length = stride * step.norm();
  const double full_cross_section = spacing.prod() / step.norm();

  Lattice::Node begin{};
  Lattice::Node end{};
  for (int axis = 0; axis < 3; ++axis) {
    begin[axis] = direction[axis] < 0 ? stride : 0;
    end[axis] = lattice.resolution[axis] - (direction[axis] > 0 ? stride : 0);
  }
  const auto on_border = [&](int axis, Index node) {
    const Index resolution = lattice.resolution[axis];
    return direction[axis] == 0 && resolution > 1 && (node == 0 || node == resolution - 1);
  };
  const Index offset = stride * lattice.number(direction);
  for (Index k = begin[2]; k < end[2]; ++k) {
    for (Index j = begin[1]; j < end[1]; ++j) {
      for (Index i = begin[0]; i < end[0]; ++i) {
        double cross_section = full_cross_section;
        if (on_border(0, i)) cross_section /= 2.0;
        if (on_border(1, j)) cross_section /= 2.0;
        if (on_border(2, k)) cross_section /= 2.0;
        const Index particle = lattice.number({i, j, k});
        append_spring(springs, particle, particle + offset, rest_length, material, cross_section, kind);
      }
    }
  }
}

}  // namespace

std::vector<Vector3> Lattice::positions() const {
  // The outermost particles lie exactly on the border, and opposite particles are exact mirror images.
  const auto coordinate = [&](int axis, Index i) {
    const Index cells = resolution[axis] - 1;
    return cells == 0 ? 0.0 : size[axis] / 2.0 * (static_cast<double>(2 * std::int64_t{i} - cells) / cells);
  };
  std::vector<Vector3> positions;
  positions.reserve(static_cast<std::size_t>(resolution[0]) * resolution[1] * resolution[2]);
  for (Index k = 0; k < resolution[2]; ++k) {
    for (Index j = 0; j < resolution[1]; ++j) {
      for (Index i = 0; i < resolution[0]; ++i) positions.emplace_back(coordinate(0, i), coordinate(1, j), coordinate(2, k));
    }
  }
  return positions;
}

Vector3 Lattice::spacing() const {
  Vector3 spacing = size;
  for (int axis = 0; axis < 3; ++axis) {
    if (resolution[axis] > 1) spacing[axis] /= resolution[axis] - 1;
  }
  return spacing;
}

std::vector<double> Lattice::measures() const {
  const Vector3 cell = spacing();
  const auto extent = [&](int axis, Index i) {
    const bool on_border = resolution[axis] > 1 && (i == 0 || i + 1 == resolution[axis]);
    return on_border ? cell[axis] / 2.0 : cell[axis];
  };
  std::vector<double> measures;
  measures.reserve(static_cast<std::size_t>(resolution[0]) * resolution[1] * resolution[2]);
  for (Index k = 0; k < resolution[2]; ++k) {
    for (Index j = 0; j < resolution[1]; ++j) {
      for (Index i = 0; i < resolution[0]; ++i) measures.push_back(extent(0, i) * extent(1, j) * extent(2, k));
    }
  }
  return measures;
}

Cells lattice_cells(const Lattice& lattice) {
  Cells cells;
  for (Index k = 0; k + 1 < lattice.resolution[2]; ++k) {
    for (Index j = 0; j + 1 < lattice.resolution[1]; ++j) {
      for (Index i = 0; i + 1 < lattice.resolution[0]; ++i) {
        Hexahedron& cell = cells.hexahedra.emplace_back();
        for (Index c = 0; c < 8; ++c) cell[c] = lattice.number({i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)});
      }
    }
  }
  return cells;
}

void add_lattice_springs(const Lattice& lattice, const SpringMaterials& materials, Springs& springs) {
  for (const Direction& direction : kAxes) {
    if (materials.structural) add_family(lattice, direction, 1, *materials.structural, SpringKind::structural, springs);
  }
  for (const Direction& direction : kDiagonals) {
    if (materials.shear) add_family(lattice, direction, 1, *materials.shear, SpringKind::shear, springs);
  }
  if (materials.bend_model == SpringMaterials::BendModel::angle) return;
  for (const Direction& direction : kAxes) {
    if (materials.bend) add_family(lattice, direction, 2, *materials.bend, SpringKind::bend, springs);
  }
}

void add_lattice_angle_bends(const Lattice& lattice, const SpringMaterial& material, AngleBends& bends) {
  const Vector3 spacing = lattice.spacing();
  for (int axis = 0; axis < 2; ++axis) {
    const int across = 1 - axis;
    const std::array<double, 2> lengths{spacing[axis], spacing[axis]};
    const Index stride = axis == 0 ? 1 : lattice.resolution[0];
    for (Index j = 0; j < lattice.resolution[1] - (axis == 1 ? 2 : 0); ++j) {
      for (Index i = 0; i < lattice.resolution[0] - (axis == 0 ? 2 : 0); ++i) {
        const Index row = across == 0 ? i : j;
        const bool on_border = row == 0 || row + 1 == lattice.resolution[across];
        const double width = on_border ? spacing[across] / 2.0 : spacing[across];
        const Index first = lattice.number({i, j, 0});
        const double stiffness = stiffness_of(material, width, spacing[axis]);
        bends.append({first, first + stride, first + 2 * stride}, lengths, stiffness, damping_of(material, stiffness));
      }
    }
  }
}

void add_layer_triangles(const Lattice& lattice, int axis, Index layer, bool along, std::vector<std::array<Index, 3>>& triangles) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  for (Index j = 0; j + 1 < lattice.resolution[v]; ++j) {
    for (Index i = 0; i + 1 < lattice.resolution[u]; ++i) {
      const auto corner = [&](Index di, Index dj) {
        Lattice::Node node{};
        node[axis] = layer;
        node[u] = i + (along ? di : dj);
        node[v] = j + (along ? dj : di);
        return lattice.number(node);
      };
      const Index a = corner(0, 0);
      const Index b = corner(1, 0);
      const Index c = corner(1, 1);
      const Index d = corner(0, 1);
      if ((i + j) % 2 == 0) {
        triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        triangles.insert(triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
}

Triangles to_triangles(const std::vector<std::array<Index, 3>>& triangles) {
  Triangles result(3, static_cast<Eigen::Index>(triangles.size()));
  for (Eigen::Index t = 0; t < result.cols(); ++t) result.col(t) << triangles[t][0], triangles[t][1], triangles[t][2];
  return result;
}

}  // namespace sprung
