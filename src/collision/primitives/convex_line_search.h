// Where along an edge its distance from a convex shape is smallest.
#pragma once

namespace sprung {

/// A point of an edge.
struct EdgeSample {
  double along = 0.0;     ///< from the edge's begin [m]
  double distance = 0.0;  ///< from the shape [m]
  double slope = 0.0;     ///< of the distance along the edge
};

/// Where the tangents of two samples cross: nowhere between is the distance, which is convex, smaller.
[[nodiscard]] EdgeSample crossing_of_tangents(const EdgeSample& low, const EdgeSample& high);

/// The part of an edge that holds the smallest distance: it falls at the begin and rises at the end.
class ConvexLineSearch {
 public:
  ConvexLineSearch(const EdgeSample& low, const EdgeSample& high) : low_(low), high_(high), width_(high.along - low.along) {}

  /// Where to sample next [m]: where the smallest distance would be if the shape was round, then if it had an edge there, then in
  /// the middle if that did not halve the bracket.
  [[nodiscard]] double next();

  /// Whether this is between the ends [m].
  [[nodiscard]] bool holds(double along) const { return along > low_.along && along < high_.along; }

  /// Leaves out what is on the far side of the sample, which is between the ends.
  void cut(const EdgeSample& at) { (at.slope < 0.0 ? low_ : high_) = at; }

 private:
  EdgeSample low_;
  EdgeSample high_;
  double width_;
  int steps_ = 0;
};

}  // namespace sprung
