// Finds the point of an edge with the smallest distance from a convex shape.
#pragma once

namespace sprung {

/// A point of an edge.
struct EdgeSample {
  double along = 0.0;     ///< from the begin of the edge [m]
  double distance = 0.0;  ///< from the shape [m]
  double slope = 0.0;     ///< of the distance along the edge
};

/// The intersection of the tangents of two samples. The distance is convex, so it is nowhere smaller between them.
[[nodiscard]] EdgeSample crossing_of_tangents(const EdgeSample& low, const EdgeSample& high);

/// A bracket of the minimum: the distance decreases at its begin and increases at its end.
class ConvexLineSearch {
 public:
  ConvexLineSearch(const EdgeSample& low, const EdgeSample& high) : low_(low), high_(high), width_(high.along - low.along) {}

  /// The position of the next sample [m]. Three rules alternate: the minimum for a single closest point, the intersection of the
  /// tangents, and bisection if the first two did not halve the bracket.
  [[nodiscard]] double next();

  /// Whether the position [m] is inside the bracket.
  [[nodiscard]] bool contains(double along) const { return along > low_.along && along < high_.along; }

  /// Cuts the bracket at a sample inside it.
  void cut(const EdgeSample& at) { (at.slope < 0.0 ? low_ : high_) = at; }

 private:
  EdgeSample low_;
  EdgeSample high_;
  double width_;
  int steps_ = 0;
};

}  // namespace sprung
