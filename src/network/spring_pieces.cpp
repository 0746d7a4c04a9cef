#include "network/spring_pieces.h"

#include "geometry/mesh/union_find.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

namespace sprung {
namespace {

UnionFind sets_of(const SpringNetwork& network, const Body& body) {
  UnionFind sets(body.particle_count);
  const auto join = [&](Index a, Index b) { sets.join(a - body.first_particle, b - body.first_particle); };
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    join(network.springs.first[s], network.springs.second[s]);
  }
  const AngleBends& bends = network.angle_bends;
  for (Index a = body.first_angle_bend; a < body.first_angle_bend + body.angle_bend_count; ++a) {
    join(bends.before[a], bends.middle[a]);
    join(bends.middle[a], bends.after[a]);
  }
  return sets;
}

/// Whether particles of different sets have the same position. `set_of` holds each particle's set.
bool any_touch(const Points& positions, Index first, const std::vector<Index>& set_of) {
  const auto key = [&](Index i) {
    const auto x = positions.col(first + i);
    return std::tuple(x[0], x[1], x[2], set_of[i]);
  };
  std::vector<Index> order(set_of.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
  return std::adjacent_find(order.begin(), order.end(), [&](Index a, Index b) {
           return set_of[a] != set_of[b] && positions.col(first + a) == positions.col(first + b);
         }) != order.end();
}

}  // namespace

SpringPieces spring_pieces(const SpringNetwork& network, const Body& body) {
  UnionFind sets = sets_of(network, body);
  std::vector<Index> set_of(static_cast<std::size_t>(body.particle_count));
  std::vector<Index> sizes(set_of.size(), 0);
  for (Index i = 0; i < body.particle_count; ++i) ++sizes[set_of[i] = sets.root(i)];
  SpringPieces pieces;
  pieces.alone = static_cast<Index>(std::count(sizes.begin(), sizes.end(), 1));
  pieces.count = static_cast<Index>(std::count_if(sizes.begin(), sizes.end(), [](Index size) { return size > 1; }));
  pieces.touch = pieces.count + pieces.alone > 1 && any_touch(network.positions, body.first_particle, set_of);
  return pieces;
}

}  // namespace sprung
