#include "dress_shapes.h"

#include "mesh_shapes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

namespace sprung::meshes {
namespace {

/// An ellipse at a height [m].
struct Section {
  double height;
  double half_width;
  double half_depth;
};

constexpr Section kFigure[] = {{0.000, 0.000, 0.000}, {0.000, 0.200, 0.200}, {0.025, 0.200, 0.200}, {0.040, 0.040, 0.040},
                               {0.060, 0.022, 0.022}, {0.780, 0.022, 0.022}, {0.800, 0.100, 0.080}, {0.840, 0.150, 0.112},
                               {0.900, 0.172, 0.127}, {0.950, 0.175, 0.130}, {1.000, 0.166, 0.122}, {1.050, 0.145, 0.108},
                               {1.100, 0.127, 0.098}, {1.140, 0.122, 0.096}, {1.180, 0.126, 0.100}, {1.240, 0.143, 0.112},
                               {1.300, 0.157, 0.120}, {1.350, 0.163, 0.112}, {1.400, 0.168, 0.094}, {1.430, 0.160, 0.080},
                               {1.455, 0.125, 0.068}, {1.475, 0.075, 0.060}, {1.495, 0.055, 0.056}, {1.530, 0.048, 0.052},
                               {1.560, 0.052, 0.062}, {1.600, 0.070, 0.086}, {1.650, 0.078, 0.098}, {1.700, 0.074, 0.093},
                               {1.740, 0.055, 0.068}, {1.765, 0.028, 0.035}, {1.775, 0.000, 0.000}};

constexpr Index kAround = 48;

Section section_at(double height) {
  const auto above = std::ranges::find_if(kFigure, [&](const Section& section) { return section.height > height; });
  const Section& from = *std::prev(above);
  const double part = (height - from.height) / (above->height - from.height);
  return {height, from.half_width + part * (above->half_width - from.half_width),
          from.half_depth + part * (above->half_depth - from.half_depth)};
}

constexpr double kGap = 0.006;
constexpr double kTop = 1.33;
constexpr double kWaist = 1.13;
constexpr Index kBodiceRows = 6;
constexpr Index kSkirtRows = 15;
constexpr Index kRows = kBodiceRows + kSkirtRows;
constexpr Index kPanelColumns = 32;
constexpr double kSkirtLength = 0.6;
constexpr double kSkirtAngle = 50.0;  // [degrees] of the skirt from the vertical
constexpr double kFirstAngle = 0.7;   // of the first row, as a fraction; the third row has the whole angle
constexpr double kRipple = 0.03;      // of the hem
constexpr double kRipples = 8.0;
constexpr double kUvScale = 0.25;  // [1/m]: the hem of a panel is 1.8 m wide and gets less than half of the picture

struct Band {
  const char* name;
  Index first_row;
  Index end_row;
};
constexpr Band kBands[] = {
    {"collar", 0, 1}, {"bodice", 1, kBodiceRows - 1}, {"waist", kBodiceRows - 1, kBodiceRows}, {"skirt", kBodiceRows, kRows}};

/// A row of vertices.
struct Row {
  Section section;
  double ripple;  ///< [m]
  double length;  ///< from the collar along the cloth [m]
};

std::vector<Row> rows_of_dress() {
  std::vector<Row> rows;
  for (Index r = 0; r <= kBodiceRows; ++r) {
    Section section = section_at(kTop + (kWaist - kTop) * r / kBodiceRows);
    section.half_width += kGap;
    section.half_depth += kGap;
    const double length = r == 0 ? 0.0
                                 : rows.back().length + std::hypot(section.height - rows.back().section.height,
                                                                   section.half_width - rows.back().section.half_width);
    rows.push_back({section, 0.0, length});
  }
  constexpr double kRow = kSkirtLength / kSkirtRows;
  for (Index r = 1; r <= kSkirtRows; ++r) {
    const double angle = kSkirtAngle * std::numbers::pi / 180.0 * std::min(1.0, kFirstAngle + (1.0 - kFirstAngle) * (r - 1) / 2.0);
    const Row& above = rows.back();
    const double outward = kRow * std::sin(angle);
    rows.push_back(
        {{above.section.height - kRow * std::cos(angle), above.section.half_width + outward, above.section.half_depth + outward},
         kRipple * r / kSkirtRows,
         above.length + kRow});
  }
  return rows;
}

Index vertex_of(Index panel, Index row, Index column) { return (panel * (kRows + 1) + row) * (kPanelColumns + 1) + column; }

/// Both panels, each from seam to seam, with their flat patterns side by side as UVs.
void add_vertices(PolygonMesh& mesh) {
  const std::vector<Row> rows = rows_of_dress();
  mesh.vertices.resize(3, 2 * vertex_of(1, 0, 0));
  Index vertex = 0;
  for (Index panel = 0; panel < 2; ++panel) {
    for (const Row& row : rows) {
      // Half of the girth in the flat pattern, about.
      const double girth = std::numbers::pi * 0.5 * (row.section.half_width + row.section.half_depth);
      for (Index column = 0; column <= kPanelColumns; ++column) {
        const double part = static_cast<double>(column) / kPanelColumns;
        const double angle = std::numbers::pi * (part + static_cast<double>(panel));
        const double ripple = row.ripple * std::cos(kRipples * angle);
        mesh.vertices.col(vertex++) << to_micrometre((row.section.half_width + ripple) * std::cos(angle)),
            to_micrometre(row.section.height), to_micrometre((row.section.half_depth + ripple) * std::sin(angle));
        mesh.faces.texcoords.push_back({to_micrometre(0.25 + 0.5 * static_cast<double>(panel) + kUvScale * (part - 0.5) * girth),
                                        to_micrometre(1.0 - kUvScale * row.length)});
      }
    }
  }
}

}  // namespace

TriangleMesh figure() {
  std::vector<ProfilePoint> profile;
  for (const Section& section : kFigure) profile.push_back({section.half_width, section.height});
  TriangleMesh mesh = revolve(profile, kAround);
  // A revolved profile has circles; each becomes its ellipse.
  Index first = 0;
  for (const Section& section : kFigure) {
    if (section.half_width == 0.0) {
      ++first;
      continue;
    }
    for (double& depth : mesh.vertices.row(2).segment(first, kAround))
      depth = to_micrometre(depth * section.half_depth / section.half_width);
    first += kAround;
  }
  return mesh;
}

PolygonMesh dress() {
  PolygonMesh mesh;
  add_vertices(mesh);
  PolygonFaces& faces = mesh.faces;
  for (const Band& band : kBands) {
    faces.groups.emplace_back(band.name);
    faces.group_begin.push_back(faces.face_count());
    for (Index panel = 0; panel < 2; ++panel) {
      for (Index row = band.first_row; row < band.end_row; ++row) {
        for (Index column = 0; column < kPanelColumns; ++column) {
          for (const Index vertex : {vertex_of(panel, row, column), vertex_of(panel, row, column + 1),
                                     vertex_of(panel, row + 1, column + 1), vertex_of(panel, row + 1, column)}) {
            faces.vertex.push_back(vertex);
            faces.texcoord.push_back(vertex);
          }
          faces.corner_begin.push_back(static_cast<Index>(faces.vertex.size()));
        }
      }
    }
  }
  mesh.lines.resize(2, 0);
  return mesh;
}

}  // namespace sprung::meshes
