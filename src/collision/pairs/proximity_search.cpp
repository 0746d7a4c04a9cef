#include "collision/pairs/proximity_search.h"

#include "base/parallel.h"
#include "collision/core/block_bounds.h"
#include "collision/core/contact.h"
#include "collision/element_bvh/feature_filters.h"

#include <algorithm>

namespace sprung {
namespace {

// Limits of gap and margin within a body, as fractions of the distance at rest. A flat sheet is then far from contact, and a folded
// one keeps its thickness if its elements are large enough.
constexpr double kMaxGapOfRest = 0.4;
constexpr double kMaxMarginOfRest = 0.1;

constexpr Index kLeafPairsPerTask = 16;

}  // namespace

ProximitySearch::ProximitySearch(const CollisionSurface& surface, const SurfaceTopology& topology,
                                 const FeatureEdges& feature_edges, const ElementBvh& tree, const Points& rest, double margin)
    : surface_(surface),
      topology_(topology),
      feature_edges_(feature_edges),
      tree_(tree),
      rest_(rest),
      margin_(margin),
      largest_gap_(surface.thickness.maxCoeff()),
      sides_(static_cast<std::size_t>(tree.leaf_count())) {
  for (std::size_t number = 0; number < sides_.size(); ++number) {
    Side& side = sides_[number];
    side.leaf = &tree.leaf(static_cast<Index>(number));
    for (int lane = 0; lane < side.leaf->count; ++lane) {
      const Index own = side.leaf->element[static_cast<std::size_t>(lane)];
      for (int k = 0; k < element(own).corners; ++k) {
        if (topology.owns_corner(own, k)) side.vertices.push_back({lane, k});
      }
      for (int k = 0; k < edges_of(element(own)); ++k) {
        if (topology.owns_edge(own, k)) side.edges.push_back({lane, k});
      }
    }
  }
}

std::vector<ContactCandidate> ProximitySearch::find_candidates(const VertexBounds& spheres, const std::vector<char>& marked,
                                                               HorizonTimes times) {
  const Search search{spheres, marked, times};
  const std::vector<ElementBvh::LeafPair> pairs = tree_.find_pairs(times, largest_gap_ + margin_);
  tree_.for_each_leaf(pairs, [&](std::size_t k) { prepare(sides_[k], search); });
  const auto count = static_cast<Index>(pairs.size());
  return collect_from_chunks<ContactCandidate>(count, kLeafPairsPerTask, [&](Index begin, Index end, auto& batch) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      const Side& a = sides_[static_cast<std::size_t>(pairs[k].first)];
      const Side& b = sides_[static_cast<std::size_t>(pairs[k].second)];
      const LaneBytes near = lanes_near(a, b, search);
      append_vertices(a, b, near, search, batch);
      if (&a != &b) append_vertices(b, a, lanes_near(b, a, search), search, batch);
      append_edges(a, b, near, search, batch);
    }
  });
}

void ProximitySearch::prepare(Side& side, const Search& search) const {
  find_corners(*side.leaf, search.times, side.corners);
  side.largest_radius = 0.0F;
  side.largest_displacement = 0.0F;
  for (int lane = 0; lane < side.leaf->count; ++lane) {
    side.largest_radius = std::max(side.largest_radius, float{side.leaf->radius[lane]});
    for (int k = 0; k < 3; ++k) {
      const Index i = side.leaf->particle[k][lane];
      side.largest_displacement =
          std::max(side.largest_displacement, static_cast<float>(search.spheres.motion(i).norm() + search.spheres.radius(i)));
    }
  }
  prepare_edges(side, search);
}

void ProximitySearch::prepare_edges(Side& side, const Search& search) const {
  const ElementBvhLeaf& leaf = *side.leaf;
  side.feature_edges.clear();
  for (const auto& [lane, k] : side.edges) {
    if (feature_edges_.is_sharp(topology_.edge(leaf.element[static_cast<std::size_t>(lane)], k)))
      side.feature_edges.push_back({lane, k});
  }
  side.edge_lanes.assign((side.feature_edges.size() + kFloatSimdWidth - 1) / kFloatSimdWidth, EdgeLanes{});
  for (std::size_t number = 0; number < side.feature_edges.size(); ++number) {
    EdgeLanes& lanes = side.edge_lanes[number / kFloatSimdWidth];
    const auto at = number % kFloatSimdWidth;
    const auto [lane, k] = side.feature_edges[number];
    const int corners = element(leaf.element[static_cast<std::size_t>(lane)]).corners;
    bool marked = false;
    for (int end = 0; end < 2; ++end) {
      const int corner = (k + end) % corners;
      for (int axis = 0; axis < 3; ++axis) {
        lanes.now[end][axis][at] = side.corners.now[corner][axis][lane];
        lanes.end[end][axis][at] = side.corners.end[corner][axis][lane];
      }
      const Index particle = leaf.particle[corner][lane];
      lanes.particle[end][at] = particle;
      marked = marked || search.marked[static_cast<std::size_t>(particle)] != 0;
    }
    lanes.radius[at] = leaf.radius[lane];
    lanes.marked[at] = marked ? -1 : 0;
    lanes.used[at] = -1;
  }
}

LaneBytes ProximitySearch::lanes_near(const Side& a, const Side& b, const Search& search) const {
  const float margin = reach_between(a, b) + b.largest_radius;
  LaneBytes near{};
  if (b.leaf->any_marked()) find_lanes_near(*a.leaf, b.leaf->marked_bounds, search.times, margin, near);
  if (!a.leaf->any_marked()) return near;
  LaneBytes marked;
  LaneBytes near_all;
  store(a.leaf->marked, marked);
  find_lanes_near(*a.leaf, b.leaf->bounds, search.times, margin, near_all);
  return either(near, both(near_all, marked));
}

void ProximitySearch::append_vertices(const Side& a, const Side& b, const LaneBytes& near, const Search& search,
                                      std::vector<ContactCandidate>& candidates) const {
  const auto now = static_cast<float>(search.times.now);
  const auto end = static_cast<float>(search.times.end);
  const bool any_marked = b.leaf->any_marked();
  const float reach = reach_between(a, b);
  for (const auto& [lane, k] : a.vertices) {
    if (near[static_cast<std::size_t>(lane)] == 0) continue;
    const bool is_marked = search.marked[static_cast<std::size_t>(a.leaf->particle[k][lane])] != 0;
    if (!any_marked && !is_marked) continue;
    const auto axes = [lane = lane](const Float8(&x)[3]) { return KineticAabb::Axes{x[0][lane], x[1][lane], x[2][lane]}; };
    const KineticAabb::Axes start = axes(a.leaf->corner[k]);
    const KineticAabb::Axes motion = axes(a.leaf->motion[k]);
    MovingVertex vertex;
    vertex.aside = a.leaf->radius[lane] + b.largest_radius;
    vertex.reach = reach + vertex.aside;
    const KineticAabb& faces = is_marked ? b.leaf->bounds : b.leaf->marked_bounds;
    if (are_apart({start, start, motion, motion}, faces, now, end, vertex.reach)) continue;
    vertex.particle = a.leaf->particle[k][lane];
    for (int axis = 0; axis < 3; ++axis) {
      vertex.now[axis] = a.corners.now[k][axis][lane];
      vertex.end[axis] = a.corners.end[k][axis][lane];
    }
    LaneBytes hits;
    if (!find_faces(vertex, *b.leaf, b.corners, hits)) continue;
    for (std::size_t other = 0; other < kFloatSimdWidth; ++other) {
      if (hits[other] == 0) continue;
      const Index face = b.leaf->element[other];
      const auto& x = element(face).particles;
      append_if_near({.stencil = {.particles = {vertex.particle, x[0], x[1], x[2]}, .first_count = 1, .second_count = 3},
                      .elements = {a.leaf->element[static_cast<std::size_t>(lane)], face}},
                     search, candidates);
    }
  }
}

void ProximitySearch::append_edges(const Side& a, const Side& b, const LaneBytes& near, const Search& search,
                                   std::vector<ContactCandidate>& candidates) const {
  for (std::size_t own = 0; own < a.feature_edges.size(); ++own) {
    if (near[static_cast<std::size_t>(a.feature_edges[own][0])] == 0) continue;
    append_edges_near(a, own, b, &a == &b ? own + 1 : 0, search, candidates);
  }
}

void ProximitySearch::append_edges_near(const Side& a, std::size_t own, const Side& b, std::size_t from, const Search& search,
                                        std::vector<ContactCandidate>& candidates) const {
  const auto [lane, i] = a.feature_edges[own];
  const MovingEdge edge =
      moving_edge(a.edge_lanes[own / kFloatSimdWidth], static_cast<int>(own % kFloatSimdWidth), reach_between(a, b));
  if (!edge.marked && !b.leaf->any_marked()) return;
  const KineticAabb& others = edge.marked ? b.leaf->bounds : b.leaf->marked_bounds;
  if (are_apart(a.leaf->lane_bounds(lane), others, static_cast<float>(search.times.now), static_cast<float>(search.times.end),
                edge.reach))
    return;
  for (std::size_t block = from / kFloatSimdWidth; block < b.edge_lanes.size(); ++block) {
    LaneBytes hits;
    if (!find_edges(edge, b.edge_lanes[block], hits)) continue;
    for (std::size_t k = 0; k < kFloatSimdWidth; ++k) {
      const std::size_t other = kFloatSimdWidth * block + k;
      if (hits[k] == 0 || other < from) continue;
      const auto [other_lane, other_edge] = b.feature_edges[other];
      const Index first = a.leaf->element[static_cast<std::size_t>(lane)];
      const Index second = b.leaf->element[static_cast<std::size_t>(other_lane)];
      const auto x = ends_of(element(first), i);
      const auto y = ends_of(element(second), other_edge);
      append_if_near({.stencil = {.particles = {x[0], x[1], y[0], y[1]}, .first_count = 2, .second_count = 2},
                      .elements = {first, second},
                      .edge = {i, other_edge}},
                     search, candidates);
    }
  }
}

void ProximitySearch::append_if_near(ContactCandidate candidate, const Search& search,
                                     std::vector<ContactCandidate>& candidates) const {
  const auto is_marked = [&](Index i) { return search.marked[static_cast<std::size_t>(i)] != 0; };
  if (!candidate.stencil.any_of(is_marked)) return;
  const double stray = largest_stray(candidate.stencil, search);
  candidate.gap = 0.5 * (thickness(candidate.elements[0]) + thickness(candidate.elements[1]));
  const double margin = std::min(margin_, margin_of_step(candidate.gap, largest_displacement(candidate.stencil, search)));
  candidate.reach = candidate.gap + margin;
  const double distance = least_distance(candidate.stencil, search);
  if (distance - stray > candidate.reach) return;
  if (element(candidate.elements[0]).body == element(candidate.elements[1]).body) {
    const double at_rest = closest_points(candidate.stencil, corners_at(candidate.stencil, rest_)).separation().norm();
    candidate.gap = std::min(candidate.gap, kMaxGapOfRest * at_rest);
    candidate.reach = candidate.gap + std::min(margin, kMaxMarginOfRest * at_rest);
    if (distance - stray > candidate.reach) return;
  }
  candidates.push_back(candidate);
}

double ProximitySearch::largest_stray(const ContactStencil& stencil, const Search& search) {
  double first = 0.0;
  double second = 0.0;
  for (int k = 0; k < stencil.count(); ++k) {
    double& largest = k < stencil.first_count ? first : second;
    largest = std::max(largest, search.spheres.radius(stencil.particles[static_cast<std::size_t>(k)]));
  }
  return first + second;
}

double ProximitySearch::largest_displacement(const ContactStencil& stencil, const Search& search) {
  double largest = 0.0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(stencil.count()); ++k) {
    const Index i = stencil.particles[k];
    largest = std::max(largest, search.spheres.motion(i).norm() + search.spheres.radius(i));
  }
  return largest;
}

float ProximitySearch::reach_between(const Side& a, const Side& b) const {
  return static_cast<float>(
      largest_gap_ +
      std::min(margin_, margin_of_step(largest_gap_, double{std::max(a.largest_displacement, b.largest_displacement)})));
}

// Centers move linearly, so that the gap along a fixed direction is smallest at one end of the interval.
double ProximitySearch::least_distance(ContactStencil& stencil, const Search& search) {
  ContactStencil::PerParticle<Vector3> x;
  for (std::size_t k = 0; k < static_cast<std::size_t>(stencil.count()); ++k) x[k] = search.spheres.center(stencil.particles[k]);
  stencil.normal = closest_points(stencil, x).separation();
  const double distance = stencil.normal.norm();
  if (!(distance > 0.0)) return 0.0;
  stencil.normal /= distance;
  const double duration = search.times.end - search.times.now;
  const auto height_at_end = [&](int k) {
    const auto at = static_cast<std::size_t>(k);
    return stencil.normal.dot(x[at] + duration * search.spheres.motion(stencil.particles[at]));
  };
  return std::min(distance, heights_of(stencil, height_at_end).gap());
}

}  // namespace sprung
