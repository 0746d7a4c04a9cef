// Sheets and boxes of faces in several patterns.
#pragma once

#include "base/types.h"
#include "geometry/mesh/polygon_mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace sprung::testing {

enum class Pattern : std::uint8_t { parallel, alternating, crossing, irregular };
inline constexpr std::array kPatternNames{"parallel", "alternating", "crossing", "irregular"};  ///< in the order of the patterns

inline std::string name_of(Pattern pattern) { return kPatternNames.at(static_cast<std::size_t>(pattern)); }

inline constexpr std::array kPatterns{Pattern::parallel, Pattern::alternating, Pattern::crossing, Pattern::irregular};

/// A rectangle from the origin to `size` [m] in the x-z plane, of squares with diagonals. Only triangles whose corners satisfy
/// `contains` are kept. Irregular: vertices off the border and off the second column,
/// where strips are clamped, move by up to a quarter of a square; diagonals are random.
inline PolygonMesh sheet(Pattern pattern, const std::array<Index, 2>& squares, double side,
                         const std::function<bool(const Vector3&)>& contains) {
  std::mt19937 random(7);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  std::vector<Vector3> vertices;
  for (Index i = 0; i <= squares[0]; ++i) {
    for (Index j = 0; j <= squares[1]; ++j) {
      Vector3 vertex(i * side, 0.0, j * side);
      const bool inside = i > 1 && j > 0 && i < squares[0] && j < squares[1];
      if (pattern == Pattern::irregular && inside) vertex += 0.5 * side * Vector3(uniform(), 0.0, uniform());
      vertices.push_back(vertex);
    }
  }
  std::vector<std::array<Index, 3>> triangles;
  for (Index i = 0; i < squares[0]; ++i) {
    for (Index j = 0; j < squares[1]; ++j) {
      const Index a = i * (squares[1] + 1) + j;
      const Index b = a + squares[1] + 1;
      const Index c = b + 1;
      const Index d = a + 1;
      const bool rising = pattern == Pattern::parallel || (pattern == Pattern::alternating && (i + j) % 2 == 0) ||
                          (pattern == Pattern::irregular && uniform() > 0.0);
      if (pattern == Pattern::crossing) {
        const auto middle = static_cast<Index>(vertices.size());
        vertices.push_back(0.5 * (vertices[a] + vertices[c]));
        triangles.insert(triangles.end(), {{a, b, middle}, {b, c, middle}, {c, d, middle}, {d, a, middle}});
      } else if (rising) {
        triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        triangles.insert(triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
  PolygonMesh mesh;
  std::vector<Index> number(vertices.size(), kNone);
  std::vector<Vector3> used;
  for (const auto& corners : triangles) {
    if (!std::ranges::all_of(corners, [&](Index v) { return contains(vertices[v]); })) continue;
    for (const Index v : corners) {
      if (number[v] == kNone) {
        number[v] = static_cast<Index>(used.size());
        used.push_back(vertices[v]);
      }
      mesh.faces.vertex.push_back(number[v]);
    }
    mesh.faces.corner_begin.push_back(static_cast<Index>(mesh.faces.vertex.size()));
  }
  mesh.vertices.resize(3, static_cast<Index>(used.size()));
  for (std::size_t v = 0; v < used.size(); ++v) mesh.vertices.col(static_cast<Index>(v)) = used[v];
  return mesh;
}

/// A box, centred, with this number of quads along each side.
inline PolygonMesh box_of_quads(const Vector3& size, const std::array<Index, 3>& quads) {
  PolygonMesh box;
  std::map<std::array<Index, 3>, Index> vertices;
  const auto vertex = [&](const std::array<Index, 3>& at) {
    return vertices.try_emplace(at, static_cast<Index>(vertices.size())).first->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const bool far : {false, true}) {
      for (Index k = 0; k < quads[u] * quads[v]; ++k) {
        std::array<Index, 3> at{};
        at[axis] = far ? quads[axis] : 0;
        for (const Index corner : {0, 1, 3, 2}) {
          at[far ? u : v] = k % quads[far ? u : v] + (corner & 1);
          at[far ? v : u] = k / quads[far ? u : v] + (corner >> 1);
          box.faces.vertex.push_back(vertex(at));
        }
        box.faces.corner_begin.push_back(static_cast<Index>(box.faces.vertex.size()));
      }
    }
  }
  box.vertices.resize(3, static_cast<Index>(vertices.size()));
  for (const auto& [at, number] : vertices) {
    for (int axis = 0; axis < 3; ++axis) box.vertices(axis, number) = size[axis] * (1.0 * at[axis] / quads[axis] - 0.5);
  }
  box.lines.resize(2, 0);
  return box;
}

}  // namespace sprung::testing
