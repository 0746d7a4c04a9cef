#include "network/bodies/body_rules.h"
#include "network/bodies/body_shape.h"
#include "network/bodies/shape_parts.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <utility>

namespace sprung {
namespace {

using Node = std::array<Index, 3>;

// Part of the mass that surface vertices get. Contact and friction act on them: light ones would take long to pass on what they
// feel.
constexpr double kMassOfSurface = 0.5;

/// The corners of cells, numbered in the order in which cells name them.
class Nodes {
 public:
  Index number(const Node& node) {
    const auto [entry, is_new] = numbers_.try_emplace(node, static_cast<Index>(nodes_.size()));
    if (is_new) nodes_.push_back(node);
    return entry->second;
  }
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

 private:
  std::map<Node, Index> numbers_;
  std::vector<Node> nodes_;
};

Hexahedron corners_of(const Node& cell, Nodes& nodes) {
  Hexahedron corners{};
  for (Index c = 0; c < 8; ++c) corners[c] = nodes.number({cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2)});
  return corners;
}

/// A point in the cell, in [0, 1]^3.
CellPoint point_in_cell(const Hexahedron& corners, const Vector3& at) {
  CellPoint point{.corners = corners, .weights = {}};
  for (std::size_t c = 0; c < point.weights.size(); ++c) {
    point.weights[c] = 1.0;
    for (int axis = 0; axis < 3; ++axis) point.weights[c] *= (c >> axis & 1U) != 0 ? at[axis] : 1.0 - at[axis];
  }
  return point;
}

/// Two corners of cells and the cross-section [m^2] of the spring between them.
struct Link {
  SpringKind kind;
  double cross_section = 0.0;
};
using Links = std::map<std::pair<Index, Index>, Link>;

/// A cell divides the cross-sections of its springs like a solid: a quarter of an edge, half of a diagonal of a face and all of one
/// in space belong to it.
void add_links(const Hexahedron& corners, double cell_size, double fraction, Links& links) {
  constexpr std::array<double, 4> kShares{0.0, 0.25, 0.5, 1.0};
  for (unsigned a = 0; a < corners.size(); ++a) {
    for (unsigned b = a + 1; b < corners.size(); ++b) {
      const int axes = std::popcount(a ^ b);
      const SpringKind kind = axes == 1 ? SpringKind::structural : SpringKind::shear;
      Link& link = links.try_emplace(std::minmax(corners[a], corners[b]), Link{kind}).first->second;
      link.cross_section += kShares[axes] * fraction * cell_size * cell_size / std::sqrt(axes);
    }
  }
}

void add_springs(const Links& links, const SpringMaterials& materials, BodyShape& shape) {
  for (const auto& [ends, link] : links) {
    const auto& material = link.kind == SpringKind::structural ? materials.structural : materials.shear;
    if (!material) continue;
    const double length = (shape.positions[ends.second] - shape.positions[ends.first]).norm();
    append_spring(shape.springs, ends.first, ends.second, length, *material, link.cross_section, link.kind);
  }
}

/// Moves a part of each corner's measure to the vertices that it carries, in proportion to their weights.
void share_measures(BodyShape& shape) {
  std::vector<double> carried_weight(shape.positions.size(), 0.0);
  const auto for_each_weight = [&](const auto& use) {
    for (std::size_t v = 0; v < shape.carried.size(); ++v) {
      for (std::size_t c = 0; c < 8; ++c) use(v, shape.carried[v].corners[c], shape.carried[v].weights[c]);
    }
  };
  for_each_weight([&](std::size_t /*vertex*/, Index corner, double weight) { carried_weight[corner] += weight; });
  for_each_weight([&](std::size_t vertex, Index corner, double weight) {
    if (weight > 0.0) shape.measures[vertex] += kMassOfSurface * shape.measures[corner] * weight / carried_weight[corner];
  });
  for (std::size_t i = shape.carried.size(); i < shape.measures.size(); ++i) {
    if (carried_weight[i] > 0.0) shape.measures[i] *= 1.0 - kMassOfSurface;
  }
}

void check(const SpringMaterials& materials) {
  ProblemList problems;
  refuse_angle_bends(materials, "a lattice", problems);
  require_materials(materials, problems);
  problems.throw_if_any();
}

}  // namespace

LatticeShape::Numbers LatticeShape::cell_at(const Vector3& point) const {
  const Vector3 at = ((point - origin) / cell_size).array().floor();
  return {static_cast<Index>(at[0]), static_cast<Index>(at[1]), static_cast<Index>(at[2])};
}

BodyShape make_lattice_body(const LatticeShape& lattice, const SpringMaterials& materials) {
  check(materials);
  const Points& on_surface = lattice.contact.vertices;
  const auto vertices = static_cast<Index>(on_surface.cols());
  Nodes nodes;
  std::map<Node, Hexahedron> corners_at;
  Links links;
  std::vector<double> measures;
  Cells cells;
  for (const LatticeShape::Cell& cell : lattice.cells) {
    Hexahedron corners = corners_of(cell.at, nodes);
    measures.resize(nodes.nodes().size(), 0.0);
    for (Index& corner : corners) {
      measures[corner] += cell.fraction * std::pow(lattice.cell_size, 3) / 8.0;
      corner += vertices;
    }
    corners_at[cell.at] = corners;
    cells.hexahedra.push_back(corners);
    add_links(corners, lattice.cell_size, cell.fraction, links);
  }
  std::vector<Vector3> positions(on_surface.colwise().begin(), on_surface.colwise().end());
  for (const Node& node : nodes.nodes()) {
    positions.push_back(lattice.origin + lattice.cell_size * Vector3(node[0], node[1], node[2]));
  }
  BodyShape shape = shape_of_particles(std::move(positions), materials);
  shape.cells = std::move(cells);
  add_springs(links, materials, shape);
  for (Index v = 0; v < vertices; ++v) {
    const Node cell = lattice.cell_at(on_surface.col(v));
    const Vector3 at = (on_surface.col(v) - lattice.origin) / lattice.cell_size;
    shape.carried.push_back(point_in_cell(corners_at.at(cell), at - Vector3(cell[0], cell[1], cell[2])));
  }
  shape.contact_only = vertices - static_cast<Index>(lattice.surface.vertices.cols());
  shape.surface.faces = lattice.surface.faces;
  shape.surface.triangles = lattice.contact.triangles;
  shape.drag_areas = vertex_areas(shape.positions, shape.surface.triangles);
  shape.dimension = 3;
  shape.measures.assign(vertices, 0.0);
  shape.measures.insert(shape.measures.end(), measures.begin(), measures.end());
  shape.measure = 0.0;
  for (const double measure : measures) shape.measure += measure;
  share_measures(shape);
  return shape;
}

}  // namespace sprung
