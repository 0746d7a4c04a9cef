#include "collision/contact_search.h"

#include "base/parallel.h"
#include "collision/corner_meetings.h"

#include <algorithm>

namespace sprung {
namespace {

// Parts of the distance at rest that contact within a body keeps at most, and looks beyond it: a flat sheet is far from contact,
// one that folds keeps its thickness as far as its elements are large enough for it.
constexpr double kMostGap = 0.4;
constexpr double kMostMargin = 0.1;

constexpr Index kLeafPairsPerTask = 16;
constexpr Index kLeavesPerTask = 64;

}  // namespace

ContactSearch::ContactSearch(const CollisionSurface& surface, const SurfaceFeatures& features, const SharpEdges& sharp,
                             const ElementTree& tree, const Points& rest, double margin)
    : surface_(surface),
      features_(features),
      sharp_(sharp),
      tree_(tree),
      rest_(rest),
      margin_(margin),
      largest_reach_(surface.thickness.maxCoeff() + margin),
      sides_(static_cast<std::size_t>(tree.leaf_count())) {
  for (std::size_t number = 0; number < sides_.size(); ++number) {
    Side& side = sides_[number];
    side.leaf = &tree.leaf(static_cast<Index>(number));
    for (int lane = 0; lane < side.leaf->count; ++lane) {
      const Index own = side.leaf->element[static_cast<std::size_t>(lane)];
      for (int k = 0; k < element(own).corners; ++k) {
        if (features.owns_corner(own, k)) side.corners.push_back({lane, k});
      }
    }
  }
}

std::vector<ContactCandidate> ContactSearch::find_candidates(const MovingBalls& balls, const std::vector<char>& marked,
                                                             WatchTimes times) {
  const Search search{balls, marked, times};
  const std::vector<ElementTree::LeafPair> pairs = tree_.find_pairs(times, largest_reach_);
  prepare_sides(pairs, times);
  const auto count = static_cast<Index>(pairs.size());
  std::vector<std::vector<ContactCandidate>> parts(static_cast<std::size_t>((count + kLeafPairsPerTask - 1) / kLeafPairsPerTask));
  parallel_chunks(count, kLeafPairsPerTask, [&](Index begin, Index end) {
    std::vector<ContactCandidate>& part = parts[static_cast<std::size_t>(begin / kLeafPairsPerTask)];
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      const Side& a = sides_[static_cast<std::size_t>(pairs[k].first)];
      const Side& b = sides_[static_cast<std::size_t>(pairs[k].second)];
      append_corners(a, b, search, part);
      if (&a != &b) append_corners(b, a, search, part);
      if (a.any_sharp && b.any_sharp) append_edges(a, b, search, part);
    }
  });
  std::vector<ContactCandidate> candidates;
  for (const std::vector<ContactCandidate>& part : parts) candidates.insert(candidates.end(), part.begin(), part.end());
  return candidates;
}

void ContactSearch::prepare_sides(const std::vector<ElementTree::LeafPair>& pairs, WatchTimes times) {
  std::vector<char> needed(sides_.size(), 0);
  for (const ElementTree::LeafPair& pair : pairs) {
    needed[static_cast<std::size_t>(pair.first)] = 1;
    needed[static_cast<std::size_t>(pair.second)] = 1;
  }
  parallel_chunks(tree_.leaf_count(), kLeavesPerTask, [&](Index begin, Index end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      if (needed[k] != 0) prepare(sides_[k], times);
    }
  });
}

void ContactSearch::prepare(Side& side, WatchTimes times) const {
  place_corners(*side.leaf, times, side.places);
  side.any_sharp = false;
  side.largest_radius = 0.0F;
  for (int lane = 0; lane < side.leaf->count; ++lane) {
    side.sharp[lane] = owns_sharp_edge(side.leaf->element[static_cast<std::size_t>(lane)]);
    side.any_sharp = side.any_sharp || side.sharp[lane];
    side.largest_radius = std::max(side.largest_radius, float{side.leaf->radius[lane]});
  }
}

void ContactSearch::append_corners(const Side& a, const Side& b, const Search& search,
                                   std::vector<ContactCandidate>& candidates) const {
  const auto now = static_cast<float>(search.times.now);
  const auto end = static_cast<float>(search.times.end);
  const bool any_marked = b.leaf->any_marked();
  for (const auto& [lane, k] : a.corners) {
    if (!any_marked && a.leaf->marked[lane] == 0) continue;
    const auto axes = [lane = lane](const TreeLanes(&x)[3]) { return MovingBounds::Axes{x[0][lane], x[1][lane], x[2][lane]}; };
    const MovingBounds::Axes start = axes(a.leaf->corner[k]);
    const MovingBounds::Axes motion = axes(a.leaf->motion[k]);
    CornerWay corner;
    corner.aside = a.leaf->radius[lane] + b.largest_radius;
    corner.reach = static_cast<float>(largest_reach_) + corner.aside;
    if (are_apart({start, start, motion, motion}, b.leaf->bounds, now, end, corner.reach)) continue;
    corner.particle = a.leaf->particle[k][lane];
    for (int axis = 0; axis < 3; ++axis) {
      corner.now[axis] = a.places.now[k][axis][lane];
      corner.end[axis] = a.places.end[k][axis][lane];
    }
    LaneBytes met;
    if (!find_faces(corner, *b.leaf, b.places, met)) continue;
    for (std::size_t other = 0; other < kTreeLanes; ++other) {
      if (met[other] == 0) continue;
      const Index face = b.leaf->element[other];
      const auto& x = element(face).particles;
      append_if_near({.particles = {corner.particle, x[0], x[1], x[2]},
                      .edges = false,
                      .elements = {a.leaf->element[static_cast<std::size_t>(lane)], face}},
                     search, candidates);
    }
  }
}

void ContactSearch::append_edges(const Side& a, const Side& b, const Search& search,
                                 std::vector<ContactCandidate>& candidates) const {
  const auto now = static_cast<float>(search.times.now);
  const auto end = static_cast<float>(search.times.end);
  const auto margin = static_cast<float>(largest_reach_);
  const bool any_marked = b.leaf->any_marked();
  for (int lane = 0; lane < a.leaf->count; ++lane) {
    const bool is_marked = a.leaf->marked[lane] != 0;
    if (!a.sharp[lane] || (!is_marked && !any_marked)) continue;
    const MovingBounds bounds = a.leaf->lane_bounds(lane);
    if (are_apart(bounds, b.leaf->bounds, now, end, margin)) continue;
    for (int other = &a == &b ? lane + 1 : 0; other < b.leaf->count; ++other) {
      if (!b.sharp[other] || (!is_marked && b.leaf->marked[other] == 0)) continue;
      if (are_apart(bounds, b.leaf->lane_bounds(other), now, end, margin)) continue;
      append_edges_of(a.leaf->element[static_cast<std::size_t>(lane)], b.leaf->element[static_cast<std::size_t>(other)], search,
                      candidates);
    }
  }
}

void ContactSearch::append_edges_of(Index first, Index second, const Search& search,
                                    std::vector<ContactCandidate>& candidates) const {
  for (int i = 0; i < edges_of(element(first)); ++i) {
    if (!features_.owns_edge(first, i) || !sharp_.is_sharp(features_.edge(first, i))) continue;
    const auto a = ends_of(element(first), i);
    for (int k = 0; k < edges_of(element(second)); ++k) {
      if (!features_.owns_edge(second, k) || !sharp_.is_sharp(features_.edge(second, k))) continue;
      const auto b = ends_of(element(second), k);
      if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) continue;
      append_if_near({.particles = {a[0], a[1], b[0], b[1]}, .edges = true, .elements = {first, second}, .edge = {i, k}}, search,
                     candidates);
    }
  }
}

void ContactSearch::append_if_near(ContactCandidate candidate, const Search& search,
                                   std::vector<ContactCandidate>& candidates) const {
  const auto is_marked = [&](Index i) { return search.marked[static_cast<std::size_t>(i)] != 0; };
  if (std::ranges::none_of(candidate.particles, is_marked)) return;
  const double stray = largest_stray(candidate, search);
  candidate.gap = 0.5 * (thickness(candidate.elements[0]) + thickness(candidate.elements[1]));
  candidate.reach = candidate.gap + margin_;
  const double distance = least_distance(candidate, search);
  if (distance - stray > candidate.reach) return;
  if (element(candidate.elements[0]).body == element(candidate.elements[1]).body) {
    std::array<Vector3, 4> rest;
    for (std::size_t k = 0; k < 4; ++k) rest[k] = rest_.col(candidate.particles[k]);
    const double at_rest = closest_points(candidate, rest).separation.norm();
    candidate.gap = std::min(candidate.gap, kMostGap * at_rest);
    candidate.reach = candidate.gap + std::min(margin_, kMostMargin * at_rest);
    if (distance - stray > candidate.reach) return;
  }
  candidates.push_back(candidate);
}

/// By how much particles in their balls may be nearer to each other than the balls' middles.
double ContactSearch::largest_stray(const ContactCandidate& candidate, const Search& search) {
  const auto radius = [&](std::size_t k) { return search.balls.radius(candidate.particles[k]); };
  return candidate.edges ? std::max(radius(0), radius(1)) + std::max(radius(2), radius(3))
                         : radius(0) + std::max({radius(1), radius(2), radius(3)});
}

/// Along a fixed direction what lies between them is least now or at the end.
double ContactSearch::least_distance(ContactCandidate& candidate, const Search& search) {
  std::array<Vector3, 4> x;
  for (std::size_t k = 0; k < 4; ++k) x[k] = search.balls.center(candidate.particles[k]);
  candidate.normal = closest_points(candidate, x).separation;
  const double distance = candidate.normal.norm();
  if (!(distance > 0.0)) return 0.0;
  candidate.normal /= distance;
  const double duration = search.times.end - search.times.now;
  const auto height_at_end = [&](std::size_t k) {
    return candidate.normal.dot(x[k] + duration * search.balls.motion(candidate.particles[k]));
  };
  return std::min(distance, gap_along(candidate, height_at_end));
}

bool ContactSearch::owns_sharp_edge(Index number) const {
  for (int k = 0; k < edges_of(element(number)); ++k) {
    if (features_.owns_edge(number, k) && sharp_.is_sharp(features_.edge(number, k))) return true;
  }
  return false;
}

}  // namespace sprung
