// The mesh of a body for the judges of collisions.
#pragma once

#include "geometry/mesh/triangle_mesh.h"
#include "scenarios/judge.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

namespace sprung::testing {

/// The triangles, with the first of the vertices that coincide at `positions` in place of each of them.
inline std::vector<JudgedElement> judged_triangles(const Triangles& triangles, const Points& positions) {
  std::map<std::tuple<double, double, double>, Index> first;
  std::vector<Index> vertex_of;
  for (Index i = 0; i < positions.cols(); ++i) {
    vertex_of.push_back(first.try_emplace({positions(0, i), positions(1, i), positions(2, i)}, i).first->second);
  }
  std::vector<JudgedElement> elements;
  for (const auto& triangle : triangles.colwise()) {
    elements.push_back({.particles = {vertex_of[triangle[0]], vertex_of[triangle[1]], vertex_of[triangle[2]]}, .corners = 3});
  }
  return elements;
}

}  // namespace sprung::testing
