// Tells whether a network is free of intersections, with exact predicates that share nothing with the contact code.
//
// Meshes are judged by CGAL: each answer is that of exact arithmetic on the given doubles. Primitives are judged by convex
// functions in doubles, whose rounding is far below the clearance that contact keeps. What only touches is not free.
#pragma once

#include "collision/shapes/obstacle.h"
#include "network/spring_network.h"

#include <array>
#include <memory>
#include <vector>

namespace sprung::testing {

/// A triangle or a segment of the network.
struct JudgedElement {
  std::array<Index, 3> particles{kNone, kNone, kNone};
  int corners = 0;  ///< 2 or 3: the first so many of `particles` are used
};

/// The triangles and segments of all bodies' surfaces, in the network's numbering.
[[nodiscard]] std::vector<JudgedElement> judged_elements(const SpringNetwork& network);

/// Pairs of elements that meet each other anywhere but in the particles they share.
[[nodiscard]] Index count_self_crossings(const std::vector<JudgedElement>& elements, const Points& positions);

/// The distance [m] of the segment between the particles a[0], a[1] from that between b[0], b[1].
[[nodiscard]] double segment_distance(const Points& positions, const std::array<Index, 2>& a, const std::array<Index, 2>& b);

/// One obstacle in its own frame, to which all positions [m], 3 x n, refer.
class ObstacleJudge {
 public:
  virtual ~ObstacleJudge() = default;

  /// Particles inside or on the surface; of an open mesh always 0.
  [[nodiscard]] virtual Index count_inside(const Points& positions) const = 0;

  /// Pairs of an element and a triangle of a mesh that meet; of a primitive the elements that reach into it.
  [[nodiscard]] virtual Index count_crossings(const std::vector<JudgedElement>& elements, const Points& positions) const = 0;

  /// Distance [m] of a point from the surface, inside a primitive negative. Beyond the edges of a primitive, and of an ellipsoid, a
  /// lower bound.
  [[nodiscard]] virtual double distance(const Vector3& point) const = 0;
};

/// Throws std::invalid_argument for a closed mesh that is no oriented manifold. What deforms is judged as it is at `time` [s].
[[nodiscard]] std::unique_ptr<const ObstacleJudge> judge_of(const ObstacleGeometry& geometry, double time = 0.0);
[[nodiscard]] std::unique_ptr<const ObstacleJudge> judge_of(const TriangleMesh& mesh, bool closed);

}  // namespace sprung::testing
