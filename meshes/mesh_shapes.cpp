#include "mesh_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace sprung::meshes {
namespace {

Points to_points(const std::vector<Vector3>& positions) {
  Points points(3, std::ssize(positions));
  for (Index i = 0; i < points.cols(); ++i) points.col(i) = positions[i].unaryExpr(&to_micrometre);
  return points;
}

Triangles to_triangles(const std::vector<std::array<Index, 3>>& list) {
  Triangles triangles(3, std::ssize(list));
  for (Index t = 0; t < triangles.cols(); ++t) triangles.col(t) << list[t][0], list[t][1], list[t][2];
  return triangles;
}

// Corners of quads in a lattice, each vertex made when it is first asked for.
class LatticeQuads {
 public:
  explicit LatticeQuads(const Vector3& cell) : cell_(cell) {}

  void add(const std::array<std::array<int, 3>, 4>& corners) {
    for (const std::array<int, 3>& corner : corners) mesh_.faces.vertex.push_back(vertex(corner));
    mesh_.faces.corner_begin.push_back(static_cast<Index>(mesh_.faces.vertex.size()));
  }

  [[nodiscard]] PolygonMesh take() {
    mesh_.vertices = to_points(positions_);
    mesh_.lines.resize(2, 0);
    return std::move(mesh_);
  }

 private:
  Index vertex(const std::array<int, 3>& at) {
    const auto [found, is_new] = numbers_.emplace(at, static_cast<Index>(positions_.size()));
    if (is_new) positions_.emplace_back(cell_.x() * at[0], cell_.y() * at[1], cell_.z() * at[2]);
    return found->second;
  }

  Vector3 cell_;
  PolygonMesh mesh_;
  std::vector<Vector3> positions_;
  std::map<std::array<int, 3>, Index> numbers_;
};

using IndexTriples = std::vector<std::array<Index, 3>>;

/// Divides each triangle on the unit sphere into four.
void subdivide(std::vector<Vector3>& directions, IndexTriples& triangles) {
  std::map<std::pair<Index, Index>, Index> middles;
  const auto middle = [&](Index a, Index b) {
    const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<Index>(directions.size()));
    if (is_new) directions.push_back((directions[a] + directions[b]).normalized());
    return found->second;
  };
  IndexTriples finer;
  for (const auto& [a, b, c] : triangles) {
    const std::array<Index, 3> m{middle(a, b), middle(b, c), middle(c, a)};
    finer.insert(finer.end(), {{a, m[0], m[2]}, {b, m[1], m[0]}, {c, m[2], m[1]}, m});
  }
  triangles = std::move(finer);
}

}  // namespace

double to_micrometre(double metres) { return std::round(metres * 1e6) / 1e6 + 0.0; }

TriangleMesh revolve(const std::vector<ProfilePoint>& profile, Index segments) {
  std::vector<Vector3> positions;
  std::vector<Index> first;
  for (const ProfilePoint& point : profile) {
    first.push_back(static_cast<Index>(positions.size()));
    for (Index s = 0; s < (point.radius > 0.0 ? segments : 1); ++s) {
      const double angle = 2.0 * std::numbers::pi * s / segments;
      positions.emplace_back(point.radius * std::cos(angle), point.height, point.radius * std::sin(angle));
    }
  }
  const auto vertex = [&](std::size_t point, Index s) { return first[point] + (profile[point].radius > 0.0 ? s % segments : 0); };
  std::vector<std::array<Index, 3>> triangles;
  for (std::size_t p = 0; p < profile.size(); ++p) {
    const std::size_t q = (p + 1) % profile.size();
    for (Index s = 0; s < segments; ++s) {
      if (profile[q].radius > 0.0) triangles.push_back({vertex(p, s), vertex(q, s), vertex(q, s + 1)});
      if (profile[p].radius > 0.0) triangles.push_back({vertex(p, s), vertex(q, s + 1), vertex(p, s + 1)});
    }
  }
  return {to_points(positions), to_triangles(triangles)};
}

TriangleMesh ball() {
  constexpr double kRadius = 0.1;
  constexpr Index kRows = 16;
  std::vector<ProfilePoint> arc;
  for (Index i = 0; i <= kRows; ++i) {
    const double angle = std::numbers::pi * (static_cast<double>(i) / kRows - 0.5);
    const bool pole = i == 0 || i == kRows;
    arc.push_back({pole ? 0.0 : kRadius * std::cos(angle), kRadius * std::sin(angle)});
  }
  return revolve(arc, 24);
}

TriangleMesh torus() {
  constexpr double kRing = 0.5;
  constexpr double kTube = 0.15;
  constexpr Index kAround = 20;
  std::vector<ProfilePoint> circle;
  for (Index i = 0; i < kAround; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kAround;
    circle.push_back({kRing + kTube * std::cos(angle), kTube * std::sin(angle)});
  }
  return revolve(circle, 48);
}

TriangleMesh funnel() {
  return revolve({{0.10, 0.0},
                  {0.12, 0.0},
                  {0.12, 0.2},
                  {0.12, 0.4},
                  {0.28, 0.6},
                  {0.44, 0.8},
                  {0.60, 1.0},
                  {0.58, 1.0},
                  {0.42, 0.8},
                  {0.26, 0.6},
                  {0.10, 0.4},
                  {0.10, 0.2}},
                 64);
}

TriangleMesh spike() {
  return revolve({{0.0, 0.0}, {0.5, 0.0}, {0.5, 0.05}, {0.25, 0.05}, {0.05, 0.05}, {0.03, 0.25}, {0.015, 0.4}, {0.0, 0.55}}, 48);
}

TriangleMesh sphere(int divisions) {
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<Vector3> directions;
  for (const double side : {-1.0, 1.0}) {
    for (const double end : {-golden, golden}) {
      directions.insert(directions.end(), {Vector3(side, end, 0.0), Vector3(0.0, side, end), Vector3(end, 0.0, side)});
    }
  }
  for (Vector3& direction : directions) direction.normalize();
  // Neighbours of an icosahedron are 63 degrees apart, all others at least 116.
  const auto neighbours = [&](Index a, Index b) { return directions[a].dot(directions[b]) > 0.0; };
  IndexTriples triangles;
  for (Index a = 0; a < 12; ++a) {
    for (Index b = a + 1; b < 12; ++b) {
      for (Index c = b + 1; c < 12; ++c) {
        if (!neighbours(a, b) || !neighbours(b, c) || !neighbours(c, a)) continue;
        const bool outward = directions[a].cross(directions[b]).dot(directions[c]) > 0.0;
        triangles.push_back(outward ? std::array{a, b, c} : std::array{a, c, b});
      }
    }
  }
  for (int division = 0; division < divisions; ++division) subdivide(directions, triangles);
  return {to_points(directions), to_triangles(triangles)};
}

TriangleMesh balloon() {
  constexpr double kRadius = 0.2;
  TriangleMesh mesh = sphere(4);
  for (auto&& p : mesh.vertices.colwise()) {
    const double narrow = p.y() < 0.0 ? 1.0 - 0.25 * p.y() * p.y() : 1.0;
    const double longer = p.y() < 0.0 ? 1.25 : 1.0;
    p = Vector3(kRadius * Vector3(narrow * p.x(), longer * p.y(), narrow * p.z())).unaryExpr(&to_micrometre);
  }
  return mesh;
}

TriangleMesh hills() {
  constexpr Index kCells = 40;
  std::vector<Vector3> positions;
  std::vector<std::array<Index, 3>> triangles;
  for (Index row = 0; row <= kCells; ++row) {
    for (Index column = 0; column <= kCells; ++column) {
      const double x = static_cast<double>(column) / kCells;
      const double z = static_cast<double>(row) / kCells;
      const double height =
          0.6 * std::sin(7.0 * x + 1.0) * std::cos(6.0 * z) + 0.3 * std::sin(13.0 * z + 5.0 * x) + 0.1 * std::cos(23.0 * x);
      positions.emplace_back(x, height, z);
      if (row == kCells || column == kCells) continue;
      const Index corner = row * (kCells + 1) + column;
      triangles.push_back({corner, corner + kCells + 1, corner + 1});
      triangles.push_back({corner + 1, corner + kCells + 1, corner + kCells + 2});
    }
  }
  return {to_points(positions), to_triangles(triangles)};
}

// Cells below the steps are solid; every face between a solid cell and air is a quad, so that no vertex lies on another's edge.
PolygonMesh stairs() {
  constexpr int kSteps = 8;
  LatticeQuads quads({0.3, 0.18, 0.75});
  const auto solid = [](int i, int j) { return i >= 0 && j >= 0 && i + j < kSteps; };
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; solid(i, j); ++j) {
      for (const int k : {-1, 0}) {
        if (!solid(i - 1, j)) quads.add({{{i, j, k}, {i, j, k + 1}, {i, j + 1, k + 1}, {i, j + 1, k}}});
        if (!solid(i + 1, j)) quads.add({{{i + 1, j, k}, {i + 1, j + 1, k}, {i + 1, j + 1, k + 1}, {i + 1, j, k + 1}}});
        if (!solid(i, j - 1)) quads.add({{{i, j, k}, {i + 1, j, k}, {i + 1, j, k + 1}, {i, j, k + 1}}});
        if (!solid(i, j + 1)) quads.add({{{i, j + 1, k}, {i, j + 1, k + 1}, {i + 1, j + 1, k + 1}, {i + 1, j + 1, k}}});
      }
      quads.add({{{i, j, -1}, {i, j + 1, -1}, {i + 1, j + 1, -1}, {i + 1, j, -1}}});
      quads.add({{{i, j, 1}, {i + 1, j, 1}, {i + 1, j + 1, 1}, {i, j + 1, 1}}});
    }
  }
  return quads.take();
}

PolygonMesh waves(double part) {
  constexpr int kHalf = 6;
  constexpr double kLength = 0.9;
  constexpr double kHeight = 0.08;
  LatticeQuads quads({0.15, 0.4, 0.15});
  for (int k = -kHalf; k < kHalf; ++k) {
    for (int i = -kHalf; i < kHalf; ++i) {
      quads.add({{{i, 0, k}, {i, 0, k + 1}, {i + 1, 0, k + 1}, {i + 1, 0, k}}});
      quads.add({{{i, -1, k}, {i + 1, -1, k}, {i + 1, -1, k + 1}, {i, -1, k + 1}}});
    }
    quads.add({{{-kHalf, -1, k}, {-kHalf, -1, k + 1}, {-kHalf, 0, k + 1}, {-kHalf, 0, k}}});
    quads.add({{{kHalf, -1, k}, {kHalf, 0, k}, {kHalf, 0, k + 1}, {kHalf, -1, k + 1}}});
    quads.add({{{k, -1, -kHalf}, {k, 0, -kHalf}, {k + 1, 0, -kHalf}, {k + 1, -1, -kHalf}}});
    quads.add({{{k, -1, kHalf}, {k + 1, -1, kHalf}, {k + 1, 0, kHalf}, {k, 0, kHalf}}});
  }
  PolygonMesh mesh = quads.take();
  for (auto&& vertex : mesh.vertices.colwise()) {
    if (vertex.y() < 0.0) continue;
    vertex.y() = to_micrometre(kHeight * std::sin(2.0 * std::numbers::pi * (vertex.x() / kLength - part)));
  }
  return mesh;
}

PolygonMesh thin_sheet() {
  constexpr int kHalf = 8;
  LatticeQuads quads({0.0625, 0.0, 0.0625});
  for (int k = -kHalf; k < kHalf; ++k) {
    for (int i = -kHalf; i < kHalf; ++i) quads.add({{{i, 0, k}, {i, 0, k + 1}, {i + 1, 0, k + 1}, {i + 1, 0, k}}});
  }
  return quads.take();
}

}  // namespace sprung::meshes
