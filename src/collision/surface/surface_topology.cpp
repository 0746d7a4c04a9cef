#include "collision/surface/surface_topology.h"

#include "base/grouped_entries.h"
#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace sprung {
namespace {

/// The edge of a triangle opposite to one of its corners.
using Rim = std::array<Index, 2>;

std::vector<Rim> rims_around(Index particle, std::span<const Index> around, const std::vector<Element>& elements) {
  std::vector<Rim> rims;
  for (const Index e : around) {
    const Element& element = elements[static_cast<std::size_t>(e)];
    if (element.corners != 3) continue;
    const auto& corner = element.particles;
    const std::size_t k = corner[0] == particle ? 0 : corner[1] == particle ? 1 : 2;
    rims.push_back({corner[(k + 1) % 3], corner[(k + 2) % 3]});
  }
  return rims;
}

/// Removes a rim with this end from the list and returns its other end; kNone if there is none.
Index follow(Index end, std::vector<Rim>& rims) {
  for (std::size_t i = 0; i < rims.size(); ++i) {
    const Rim rim = rims[i];
    if (rim[0] != end && rim[1] != end) continue;
    rims.erase(rims.begin() + static_cast<std::ptrdiff_t>(i));
    return rim[0] == end ? rim[1] : rim[0];
  }
  return kNone;
}

/// Chains the rims to a single line or ring of spokes if possible; else the spokes are all their ends in ascending order.
FanKind chain(std::vector<Rim> rims, std::vector<Index>& spokes) {
  std::vector<Index> ends;
  for (const Rim& rim : rims) ends.insert(ends.end(), rim.begin(), rim.end());
  std::sort(ends.begin(), ends.end());
  std::vector<Index> single;
  bool manifold = !rims.empty();
  for (auto end = ends.begin(); end != ends.end();) {
    const auto next = std::upper_bound(end, ends.end(), *end);
    spokes.push_back(*end);
    if (next - end == 1) single.push_back(*end);
    if (next - end > 2) manifold = false;
    end = next;
  }
  if (!manifold || (!single.empty() && single.size() != 2)) return FanKind::none;

  const bool closed = single.empty();
  std::vector<Index> line{closed ? ends.front() : single.front()};
  for (Index next = follow(line.back(), rims); next != kNone; next = follow(line.back(), rims)) line.push_back(next);
  if (!rims.empty()) return FanKind::none;
  if (closed) line.pop_back();
  spokes = std::move(line);
  return closed ? FanKind::closed : FanKind::open;
}

// The squared cosine of 45 degrees.
constexpr double kTurn2 = 0.5;

constexpr Index kEdgesPerTask = 1024;

}  // namespace

SurfaceTopology::SurfaceTopology(const std::vector<Element>& elements, Index particles)
    : owned_(elements.size()), edges_(3 * elements.size(), kNone), across_(edges_.size(), kNone) {
  list_elements(elements, particles);
  give_corners(elements);
  give_edges(elements);
  build_fans(elements, particles);
}

void SurfaceTopology::list_elements(const std::vector<Element>& elements, Index particles) {
  const auto visit_all = [&](const auto& add) {
    for (std::size_t e = 0; e < elements.size(); ++e) {
      for (const Index particle : corners_of(elements[e])) add(particle, static_cast<Index>(e));
    }
  };
  group_entries(static_cast<std::size_t>(particles), visit_all, first_element_, elements_);
}

void SurfaceTopology::give_corners(const std::vector<Element>& elements) {
  for (std::size_t i = 0; i + 1 < first_element_.size(); ++i) {
    const auto around = elements_at(static_cast<Index>(i));
    if (around.empty()) continue;
    const auto first = static_cast<std::size_t>(around.front());
    const auto& corners = elements[first].particles;
    const auto corner = std::find(corners.begin(), corners.end(), static_cast<Index>(i)) - corners.begin();
    owned_[first].corners = static_cast<std::uint8_t>(owned_[first].corners | 1 << corner);
  }
}

void SurfaceTopology::give_edges(const std::vector<Element>& elements) {
  struct Use {
    std::array<Index, 2> ends;
    Side side;
  };
  std::vector<Use> uses;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (int k = 0; k < edges_of(elements[e]); ++k) {
      auto ends = ends_of(elements[e], k);
      std::sort(ends.begin(), ends.end());
      uses.push_back({ends, {static_cast<Index>(e), k}});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return std::tie(a.ends, a.side.element, a.side.edge) < std::tie(b.ends, b.side.element, b.side.edge);
  });
  for (std::size_t begin = 0; begin < uses.size();) {
    std::size_t end = begin;
    for (; end < uses.size() && uses[end].ends == uses[begin].ends; ++end) {
      edges_[slot(uses[end].side.element, uses[end].side.edge)] = edge_count();
    }
    const Side first = uses[begin].side;
    owners_.push_back(first);
    Owned& owner = owned_[static_cast<std::size_t>(first.element)];
    owner.edges = static_cast<std::uint8_t>(owner.edges | 1 << first.edge);
    if (end - begin == 2) {
      join(elements, first, uses[begin + 1].side);
      join(elements, uses[begin + 1].side, first);
    }
    begin = end;
  }
}

/// Only triangles have a neighbour across an edge.
void SurfaceTopology::join(const std::vector<Element>& elements, Side side, Side other) {
  const Element& beside = elements[static_cast<std::size_t>(other.element)];
  if (beside.corners != 3 || elements[static_cast<std::size_t>(side.element)].corners != 3) return;
  across_[slot(side.element, side.edge)] = beside.particles[static_cast<std::size_t>((other.edge + 2) % 3)];
}

void SurfaceTopology::build_fans(const std::vector<Element>& elements, Index particles) {
  fans_.resize(static_cast<std::size_t>(particles));
  first_spoke_.assign(1, 0);
  std::vector<Index> spokes;
  for (Index i = 0; i < particles; ++i) {
    spokes.clear();
    fans_[static_cast<std::size_t>(i)] = chain(rims_around(i, elements_at(i), elements), spokes);
    spokes_.insert(spokes_.end(), spokes.begin(), spokes.end());
    first_spoke_.push_back(static_cast<Index>(spokes_.size()));
  }
}

FeatureEdges::FeatureEdges(const CollisionSurface& surface, const SurfaceTopology& features)
    : surface_(surface), features_(features), sharp_(static_cast<std::size_t>(features.edge_count()), 1) {}

void FeatureEdges::update(const Points& positions) {
  parallel_chunks(features_.edge_count(), kEdgesPerTask, [&](Index begin, Index end) {
    for (Index edge = begin; edge < end; ++edge) sharp_[static_cast<std::size_t>(edge)] = is_bent(edge, positions) ? 1 : 0;
  });
}

bool FeatureEdges::is_bent(Index edge, const Points& positions) const {
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
