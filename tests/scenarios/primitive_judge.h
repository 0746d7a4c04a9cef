// Judges primitives, all of which are convex, by a convex function of each.
#pragma once

#include "scenarios/judge.h"

namespace sprung::testing {

/// A convex function of position: negative inside the primitive, 0 on its surface, and outside at most the distance.
struct ConvexMeasure {
  double value = 0.0;               ///< [m]; at two points it differs by at most their distance
  Vector3 slope = Vector3::Zero();  ///< of a tangent plane, which is nowhere above the function
};

/// Requires a primitive.
[[nodiscard]] ConvexMeasure convex_measure(const ObstacleGeometry& geometry, const Vector3& p);

[[nodiscard]] std::unique_ptr<const ObstacleJudge> judge_of_primitive(const ObstacleGeometry& geometry);

}  // namespace sprung::testing
