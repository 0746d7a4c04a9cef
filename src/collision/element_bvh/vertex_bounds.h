// A ball around each particle that moves on with it from step to step: where the particle is free to be.
//
// What two elements' balls rule out for many steps need not be looked at in any of them. Balls move at constant speed until their
// particle leaves them, so that what flies together keeps its balls, at any speed.
#pragma once

#include "base/types.h"

#include <vector>

namespace sprung {

/// Times are in steps, from the begin of the step at hand. Positions within a ball at a step's begin and end stay in it in between,
/// when they move straight.
class VertexBounds {
 public:
  /// Balls of these radii [m], none of which has a place yet.
  explicit VertexBounds(std::vector<double> radius)
      : radius_(std::move(radius)), center_(Points::Zero(3, count())), motion_(center_) {}

  [[nodiscard]] Index count() const { return static_cast<Index>(radius_.size()); }
  [[nodiscard]] double radius(Index i) const { return radius_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] auto motion(Index i) const { return motion_.col(i); }  ///< [m per step]
  [[nodiscard]] Vector3 center(Index i, double time = 0.0) const { return center_.col(i) + time * motion_.col(i); }  ///< [m]

  /// Places a ball around where its particle is at the step's begin and about to be at its end [m].
  void place(Index i, const Vector3& begin, const Vector3& end) {
    center_.col(i) = begin;
    motion_.col(i) = end.allFinite() ? Vector3(end - begin) : Vector3::Zero();
  }

  /// Whether the ball holds p at the step's begin (time 0) or end (time 1).
  [[nodiscard]] bool holds(Index i, const Vector3& p, double time) const {
    return (p - center(i, time)).squaredNorm() <= radius(i) * radius(i);
  }

  /// The next step begins.
  void advance() { center_ += motion_; }

 private:
  std::vector<double> radius_;
  Points center_;
  Points motion_;
};

}  // namespace sprung
