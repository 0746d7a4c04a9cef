#include "collision/pairs/pair_builder.h"

#include <algorithm>
#include <span>

namespace sprung {
namespace {

ContactStencil stencil_of(std::span<const Index> first, std::span<const Index> second) {
  ContactStencil pair;
  const auto next = std::copy(first.begin(), first.end(), pair.particles.begin());
  std::copy(second.begin(), second.end(), next);
  pair.first_count = static_cast<int>(first.size());
  pair.second_count = static_cast<int>(second.size());
  return pair;
}

bool share_particle(std::span<const Index> a, std::span<const Index> b) {
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

/// Smallest gap along the normal between the spheres of both sides from now to the horizon: it is linear in time, so that both ends
/// are enough.
double least_gap(const ContactStencil& pair, const NeighbourListState& state) {
  const auto at = [&](double time) {
    return heights_of(pair,
                      [&](int k) {
                        const Index i = pair.particles[static_cast<std::size_t>(k)];
                        const double radius = k < pair.first_count ? -state.spheres.radius(i) : state.spheres.radius(i);
                        return pair.normal.dot(state.spheres.center(i, time)) + radius;
                      })
        .gap();
  };
  return std::min(at(0.0), at(state.horizon));
}

/// The line between the centroids: it separates most neighbouring vertices, edges and faces, and costs little.
Vector3 direction_between_centroids(const ContactStencil& pair, const Points& positions) {
  Vector3 first = Vector3::Zero();
  Vector3 second = Vector3::Zero();
  for (int k = 0; k < pair.count(); ++k)
    (k < pair.first_count ? first : second) += positions.col(pair.particles[static_cast<std::size_t>(k)]);
  return (first / pair.first_count - second / pair.second_count).normalized();
}

void append_if_near(ContactStencil pair, const NeighbourListState& state, std::vector<ContactStencil>& pairs) {
  pair.normal = separating_direction(pair, state.positions);
  if (!(least_gap(pair, state) > 0.0)) pairs.push_back(pair);
}

bool is_marked(const ContactStencil& pair, const NeighbourListState& state) {
  return pair.any_of([&](Index i) { return state.marked[static_cast<std::size_t>(i)] != 0; });
}

void append_feature_if_near(ContactStencil pair, const NeighbourListState& state, std::vector<ContactStencil>& pairs) {
  if (!is_marked(pair, state)) return;
  pair.normal = direction_between_centroids(pair, state.positions);
  if (!(least_gap(pair, state) > 0.0)) append_if_near(pair, state, pairs);
}

}  // namespace

void PairBuilder::append_pairs(const ElementIndexPair& elements, const NeighbourListState& state,
                               std::vector<ContactStencil>& pairs) const {
  // A stencil's second side has at least as many particles as its first.
  const bool swap = element(elements.first).corners > element(elements.second).corners;
  const Index first = swap ? elements.second : elements.first;
  const Index second = swap ? elements.first : elements.second;
  const auto a = corners_of(element(first));
  const auto b = corners_of(element(second));
  if (share_particle(a, b)) {
    append_vertices(first, second, state, pairs);
    append_vertices(second, first, state, pairs);
    append_edges(first, second, state, pairs);
  } else if (b.size() == 3 || a.size() == 2) {
    // A particle and a segment, or two particles, cannot cross.
    append_if_near(stencil_of(a, b), state, pairs);
  }
}

void PairBuilder::append_vertices(Index element_number, Index face, const NeighbourListState& state,
                                  std::vector<ContactStencil>& pairs) const {
  const auto corners = corners_of(element(element_number));
  const auto b = corners_of(element(face));
  if (b.size() != 3) return;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (!topology_.owns_corner(element_number, static_cast<int>(k))) continue;
    const std::array<Index, 1> a{corners[k]};
    if (share_particle(a, b)) continue;
    append_feature_if_near(stencil_of(a, b), state, pairs);
  }
}

void PairBuilder::append_edges(Index first, Index second, const NeighbourListState& state,
                               std::vector<ContactStencil>& pairs) const {
  for (int i = 0; i < edges_of(element(first)); ++i) {
    if (!topology_.owns_edge(first, i)) continue;
    const auto a = ends_of(element(first), i);
    for (int k = 0; k < edges_of(element(second)); ++k) {
      if (!topology_.owns_edge(second, k)) continue;
      const auto b = ends_of(element(second), k);
      if (share_particle(a, b)) continue;
      append_feature_if_near(stencil_of(a, b), state, pairs);
    }
  }
}

}  // namespace sprung
