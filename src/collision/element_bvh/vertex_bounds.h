// Moving bounding spheres of the particles: the skin of the neighbour list.
//
// Elements whose spheres stay apart for many steps need no check in any of them. A sphere moves at constant velocity until its
// particle leaves it, so that a body in free flight keeps its spheres at any speed. Fans of triangles that stay flat while their
// corners are in their spheres cannot cross themselves (normal-cone test).
#pragma once

#include "base/files/binary_archive.h"
#include "base/types.h"
#include "collision/surface/surface_topology.h"

#include <vector>

namespace sprung {

/// Times are in steps, from the begin of the current step. A particle that moves linearly and is in its sphere at the step's begin
/// and end is in it throughout the step.
class VertexBounds {
 public:
  /// Spheres of these radii [m]. Call reset() for each before use.
  explicit VertexBounds(std::vector<double> radius)
      : radius_(std::move(radius)), center_(Points::Zero(3, count())), motion_(center_) {}

  [[nodiscard]] Index count() const { return static_cast<Index>(radius_.size()); }
  [[nodiscard]] double radius(Index i) const { return radius_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] auto motion(Index i) const { return motion_.col(i); }  ///< [m per step]
  [[nodiscard]] Vector3 center(Index i, double time = 0.0) const { return center_.col(i) + time * motion_.col(i); }  ///< [m]

  /// Centers the sphere at its particle's position at the step's begin; it moves to the expected position at the end [m].
  void reset(Index i, const Vector3& begin, const Vector3& end) {
    center_.col(i) = begin;
    motion_.col(i) = end.allFinite() ? Vector3(end - begin) : Vector3::Zero();
  }

  /// Whether the sphere contains p [m] at this time.
  [[nodiscard]] bool contains(Index i, const Vector3& p, double time) const {
    return (p - center(i, time)).squaredNorm() <= radius(i) * radius(i);
  }

  /// Moves all spheres to the begin of the next step.
  void advance() { center_ += motion_; }

 private:
  template <Same<VertexBounds> S, class Visit>
  friend void visit_members(S& b, const Visit& visit) {
    visit(b.center_, b.motion_);
    if (b.center_.cols() != b.count() || b.motion_.cols() != b.count()) throw BytesError();
  }

  std::vector<double> radius_;
  Points center_;
  Points motion_;
};

/// Whether the triangles around a particle cannot cross each other for `horizon` [steps] from now while their corners stay within
/// their spheres. That is so if all triangles keep facing one direction and surround the particle less than once or, in a closed
/// fan, exactly once (Volino and Magnenat-Thalmann 1994). False where this is not certain.
[[nodiscard]] bool fan_stays_flat(const SurfaceTopology& features, Index particle, const VertexBounds& spheres, double horizon);

}  // namespace sprung
