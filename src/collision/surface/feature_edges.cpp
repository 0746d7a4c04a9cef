#include "collision/surface/feature_edges.h"

#include "base/parallel.h"

namespace sprung {
namespace {

// The squared cosine of 45 degrees.
constexpr double kTurn2 = 0.5;

constexpr Index kEdgesPerTask = 1024;

}  // namespace

FeatureEdges::FeatureEdges(const CollisionSurface& surface, const SurfaceTopology& features)
    : surface_(surface), features_(features), sharp_(static_cast<std::size_t>(features.edge_count()), 1) {}

void FeatureEdges::update(const Points& positions) {
  parallel_chunks(features_.edge_count(), kEdgesPerTask, [&](Index begin, Index end) {
    for (Index edge = begin; edge < end; ++edge) sharp_[static_cast<std::size_t>(edge)] = turns(edge, positions) ? 1 : 0;
  });
}

bool FeatureEdges::turns(Index edge, const Points& positions) const {
  const SurfaceTopology::Side side = features_.owner(edge);
  const Index across = features_.across(side.element, side.edge);
  if (across == kNone) return true;
  const Element& element = surface_.elements[static_cast<std::size_t>(side.element)];
  const auto ends = ends_of(element, side.edge);
  const Vector3 from = positions.col(ends[0]);
  const Vector3 along = positions.col(ends[1]) - from;
  const Vector3 here = positions.col(element.particles[static_cast<std::size_t>((side.edge + 2) % 3)]) - from;
  const Vector3 there = positions.col(across) - from;
  const Vector3 normal = along.cross(here);
  const Vector3 other = there.cross(along);
  const double cosine = normal.dot(other);
  return !(cosine > 0.0 && cosine * cosine >= kTurn2 * normal.squaredNorm() * other.squaredNorm());
}

}  // namespace sprung
