#include "scene/building/lattice_filling.h"

#include "base/error.h"
#include "base/format.h"
#include "base/machine/machine_memory.h"
#include "collision/mesh_bvh/mesh_bvh.h"
#include "geometry/import/mesh_import.h"
#include "geometry/mesh/edge_division.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace sprung {
namespace {

constexpr Index kMaxCells = 1024;        // along a side
constexpr double kMargin = 1.0e-3;       // of a cell, around the surface: no vertex lies on the border of the lattice
constexpr double kLeastFraction = 0.25;  // of a cell: lighter and softer ones turn inside out under their neighbours
constexpr int kSamples = 3;              // along each side of a cell
constexpr double kBytesOfCell = 4000.0;  // springs, corners and volume of a cell, measured with a million
constexpr double kGigabyte = 1.0e9;

/// The mesh. Throws InputError if it is not closed.
const TriangleMesh& closed(const ImportedMesh& mesh) {
  const MeshReport& report = mesh.report;
  if (report.closed) return mesh.mesh;
  Problem problem{.key = "file", .value = "", .rule = "must be a closed mesh, so that it has an inside", .remedy = ""};
  if (mesh.mesh.triangles.cols() == 0) {
    problem.value = "a mesh without faces that have an area";
    problem.remedy = "use a mesh with a closed surface";
  } else if (report.non_manifold_edges > 0) {
    problem.value =
        "a mesh with " + counted(static_cast<std::size_t>(report.non_manifold_edges), "edge") + " of more than two faces";
    problem.remedy = "remove the faces inside; `sprung info` describes the mesh";
  } else if (report.border_edges > 0) {
    problem.value = "an open mesh, with " + counted(static_cast<std::size_t>(report.border_edges), "border edge");
    problem.remedy = "fill its holes; `sprung info` describes them";
  } else {
    problem.value = "a mesh whose faces do not agree on what is inside";
    problem.remedy = "make them face outward; `sprung info` describes the mesh";
  }
  throw InputError(std::move(problem));
}

/// What is inside and what is outside of a surface. Vertices at the same place, as along the seams of UVs, count as one.
class Inside {
 public:
  explicit Inside(const PolygonMesh& surface) : Inside(clean_mesh({surface.vertices, triangulate(surface.faces)})) {}

  /// The fraction [0, 1] of a box that is inside.
  [[nodiscard]] double fraction(const Box3& box) const {
    find_in_box(tree_, box, near_);
    const int samples = near_.empty() ? 1 : kSamples;
    int inside = 0;
    for (int i = 0; i < samples * samples * samples; ++i) {
      const Index row = i / samples;
      const Index layer = row / samples;
      const Vector3 at(i % samples, row % samples, layer);
      const Vector3 point = box.min() + (at + Vector3::Constant(0.5)).cwiseProduct(box.sizes()) / samples;
      if (winding_number(tree_, point) != 0) ++inside;
    }
    return static_cast<double>(inside) / (samples * samples * samples);
  }

 private:
  explicit Inside(const ImportedMesh& mesh) : tree_(closed(mesh)) {}

  MeshBvh tree_;
  mutable std::vector<Index> near_;
};

void check_size(const Vector3& cells, double cell_size) {
  const std::string value = format_number(cell_size, 6) + " m";
  if (!(cells.maxCoeff() <= kMaxCells)) {
    throw InputError({.key = "cell_size",
                      .value = value,
                      .rule = "makes " + format_number(cells.maxCoeff(), 3) + " cells along a side, where at most " +
                              std::to_string(kMaxCells) + " are possible",
                      .remedy = "use larger cells"});
  }
  const double bytes = kBytesOfCell * cells.prod();
  if (bytes <= machine_memory()) return;
  throw InputError({.key = "cell_size",
                    .value = value,
                    .rule = "makes a lattice that takes up to " + format_number(bytes / kGigabyte, 3) +
                            " GB of memory, and this machine has " + format_number(machine_memory() / kGigabyte, 3) + " GB",
                    .remedy = "use larger cells"});
}

}  // namespace

LatticeShape fill_with_cells(PolygonMesh surface, double cell_size) {
  const Inside inside(surface);
  const Vector3 lower = surface.vertices.rowwise().minCoeff();
  const Vector3 upper = surface.vertices.rowwise().maxCoeff();
  LatticeShape lattice;
  lattice.surface = std::move(surface);
  // Rounding must not add a layer of cells to a side that is a multiple of them.
  const Vector3 cells = (((upper - lower) / cell_size).array() - kMargin).ceil().max(1.0);
  check_size(cells, cell_size);
  lattice.cell_size = (1.0 + 2.0 * kMargin) * cell_size;
  lattice.origin = 0.5 * (lower + upper) - 0.5 * lattice.cell_size * cells;
  // Only vertices transfer contact forces to cells, so each cell at the surface needs one.
  lattice.contact = divide_long_edges({lattice.surface.vertices, triangulate(lattice.surface.faces)}, lattice.cell_size);

  std::set<LatticeShape::Numbers> with_vertex;
  for (const auto& vertex : lattice.contact.vertices.colwise()) with_vertex.insert(lattice.cell_at(vertex));
  const auto [nx, ny, nz] =
      std::array<Index, 3>{static_cast<Index>(cells[0]), static_cast<Index>(cells[1]), static_cast<Index>(cells[2])};
  for (Index k = 0; k < nz; ++k) {
    for (Index j = 0; j < ny; ++j) {
      for (Index i = 0; i < nx; ++i) {
        const Vector3 corner = lattice.origin + lattice.cell_size * Vector3(i, j, k);
        const double fraction = inside.fraction(Box3(corner, corner + Vector3::Constant(lattice.cell_size)));
        if (fraction == 0.0 && !with_vertex.contains({i, j, k})) continue;
        lattice.cells.push_back({{i, j, k}, std::max(fraction, kLeastFraction)});
      }
    }
  }
  return lattice;
}

}  // namespace sprung
