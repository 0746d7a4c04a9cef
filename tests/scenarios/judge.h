// Tells whether a network is free of intersections, with exact predicates that share nothing with the contact code.
//
// Meshes are judged by CGAL: each answer is that of exact arithmetic on the given doubles. Primitives are judged by convex
// functions in doubles, whose rounding is far below the clearance that contact keeps. Touching counts as an intersection.
#pragma once

#include "collision/shapes/obstacle.h"
#include "network/model/spring_network.h"

#include <array>
#include <memory>
#include <vector>

namespace sprung::testing {

/// A triangle or a segment of the network.
struct JudgedElement {
  std::array<Index, 3> particles{kNone, kNone, kNone};
  int corners = 0;  ///< 2 or 3, the number of `particles` in use
};

/// The triangles and segments of all bodies' surfaces, in the network's numbering.
[[nodiscard]] std::vector<JudgedElement> judged_elements(const SpringNetwork& network);

/// Pairs of elements that intersect at a point other than a shared particle.
[[nodiscard]] Index count_self_crossings(const std::vector<JudgedElement>& elements, const Points& positions);

/// The distance [m] of the segment between the particles a[0], a[1] from that between b[0], b[1].
[[nodiscard]] double segment_distance(const Points& positions, const std::array<Index, 2>& a, const std::array<Index, 2>& b);

/// Judges one obstacle. All positions [m], 3 x n, are in the obstacle's own frame.
class ObstacleJudge {
 public:
  virtual ~ObstacleJudge() = default;

  /// The number of particles inside or on the surface; always 0 for an open mesh.
  [[nodiscard]] virtual Index count_inside(const Points& positions) const = 0;

  /// For a mesh, the number of intersecting pairs of an element and a triangle; for a primitive, the number of elements that reach
  /// into it.
  [[nodiscard]] virtual Index count_crossings(const std::vector<JudgedElement>& elements, const Points& positions) const = 0;

  /// Distance [m] of a point from the surface, negative inside a primitive. Outside of an ellipsoid, and beyond the edges of other
  /// primitives, it is a lower bound.
  [[nodiscard]] virtual double distance(const Vector3& point) const = 0;
};

/// Throws std::invalid_argument for a closed mesh that is no oriented manifold. A deforming mesh is judged in its shape at `time`
/// [s].
[[nodiscard]] std::unique_ptr<const ObstacleJudge> judge_of(const ObstacleGeometry& geometry, double time = 0.0);
[[nodiscard]] std::unique_ptr<const ObstacleJudge> judge_of(const TriangleMesh& mesh, bool closed);

}  // namespace sprung::testing
