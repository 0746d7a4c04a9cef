#include "network/spring_pieces.h"

#include "geometry/mesh/union_find.h"
#include "geometry/mesh/weld.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sprung {
namespace {

UnionFind sets_of(const SpringNetwork& network, const Body& body) {
  UnionFind sets(body.particle_count);
  const auto join = [&](Index a, Index b) { sets.join(a - body.first_particle, b - body.first_particle); };
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    join(network.springs.first[s], network.springs.second[s]);
  }
  for (std::size_t v = 0; v < body.carried.size(); ++v) sets.join(static_cast<Index>(v), body.carried[v].corners.front());
  const AngleBends& bends = network.angle_bends;
  for (Index a = body.first_angle_bend; a < body.first_angle_bend + body.angle_bend_count; ++a) {
    join(bends.before[a], bends.middle[a]);
    join(bends.middle[a], bends.after[a]);
  }
  const FaceBends& faces = network.face_bends;
  for (Index f = body.first_face_bend; f < body.first_face_bend + body.face_bend_count; ++f) {
    for (const Index hinge : faces.hinges[f]) {
      if (hinge == kNone) continue;
      const auto& [a, b, c, d] = network.hinges.particles[hinge];
      for (const Index corner : {b, c, d}) join(a, corner);
    }
  }
  return sets;
}

double power_of_ten_below(double value) { return std::pow(10.0, std::ceil(std::log10(value)) - 1.0); }

double touch_distance(const Points& positions, const SpringNetwork& network, const Body& body) {
  constexpr double kShareOfExtent = 1e-6;
  const auto first = network.springs.rest_length.begin() + body.first_spring;
  const double shortest = body.spring_count > 0 ? *std::min_element(first, first + body.spring_count) : 0.0;
  const double extent = (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).maxCoeff();
  const double near = std::pow(10.0, std::round(std::log10(kShareOfExtent * extent)));
  return near < shortest ? near : (shortest > 0.0 ? power_of_ten_below(shortest) : 0.0);
}

void add_touching(const SpringNetwork& network, const Body& body, UnionFind& sets, SpringPieces& pieces) {
  const Points positions = network.positions.middleCols(body.first_particle, body.particle_count);
  pieces.touch_distance = touch_distance(positions, network, body);
  const std::vector<Index> places = coincident_groups(positions, pieces.touch_distance);
  pieces.count_welded = pieces.count + pieces.alone;
  for (Index i = 0; i < body.particle_count; ++i) {
    if (sets.root(i) == sets.root(places[i])) continue;
    pieces.touch = true;
    --pieces.count_welded;
    sets.join(i, places[i]);
  }
}

}  // namespace

SpringPieces spring_pieces(const SpringNetwork& network, const Body& body) {
  UnionFind sets = sets_of(network, body);
  std::vector<Index> sizes(static_cast<std::size_t>(body.particle_count), 0);
  for (Index i = 0; i < body.particle_count; ++i) ++sizes[sets.root(i)];
  SpringPieces pieces;
  pieces.alone = static_cast<Index>(std::count(sizes.begin(), sizes.end(), 1));
  pieces.count = static_cast<Index>(std::count_if(sizes.begin(), sizes.end(), [](Index size) { return size > 1; }));
  if (pieces.count + pieces.alone > 1) add_touching(network, body, sets, pieces);
  return pieces;
}

}  // namespace sprung
