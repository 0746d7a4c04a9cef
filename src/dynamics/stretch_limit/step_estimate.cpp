#include "dynamics/stretch_limit/step_estimate.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace sprung {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The load of rigid surfaces relative to that of others, measured as described at largest_load.
constexpr double kTetheredShare = 5.0;
constexpr double kShare = 8.0;

struct Farthest {
  Index particle;
  Index springs;  ///< on the path there
};

/// Distances in springs from the nearest of `starts`, which are particles of the body.
Farthest farthest_from(const Body& body, const SpringGraph& graph, const std::vector<Index>& starts) {
  std::vector<Index> away(body.particle_count, kNone);
  const auto springs_to = [&](Index particle) -> Index& { return away[particle - body.first_particle]; };
  std::vector<Index> queue = starts;
  for (const Index start : starts) springs_to(start) = 0;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const Index i = queue[head];
    for (const SpringGraph::Edge& edge : graph.at(i)) {
      if (springs_to(edge.to) != kNone) continue;
      springs_to(edge.to) = springs_to(i) + 1;
      queue.push_back(edge.to);
    }
  }
  return {queue.back(), springs_to(queue.back())};
}

/// Half the springs on the path between two distant ends of the body.
double half_path(const Body& body, const SpringGraph& graph, Index start) {
  const Index end = farthest_from(body, graph, {start}).particle;
  return 0.5 * farthest_from(body, graph, {end}).springs;
}

/// Number of spring ends at the body's particles.
Index count_ends(const Body& body, const SpringGraph& graph) {
  Index ends = 0;
  for (Index i = 0; i < body.particle_count; ++i) ends += static_cast<Index>(graph.at(body.first_particle + i).size());
  return ends;
}

}  // namespace

bool is_rigid(const Body& body, const SpringGraph& graph) {
  return body.dimension == 2 && count_ends(body, graph) / 2 >= 2 * body.particle_count - 3;
}

// Passes spread excess like diffusion: a displacement u of n particles leaves on average n u / d at the pin. A spring has no
// excess right after its own projection, but its neighbours add some again: the last spring of a particle keeps the average
// excess of all its springs. Measured: 1.8 to 1.9 times the average for hanging ropes (2 springs a particle), 4.0 for
// cloths (4 springs).
//
// Tethers pass on the load that hangs straight below a pin; a strand still carries the load beside it. Measured with one pass a
// step: cloths of 24, 48 and 64 particles a side on two corners showed 0.8, 0.8 and 0.6 of a rope with as many springs.
//
// A cloth that may shrink necks and folds until few springs carry all. One that may not shares the load. Measured on two corners
// with one pass a step: without tethers, structural and shear springs (7.3 to 7.6 a particle) with 16 and 32 particles a side 1.0
// of load / d, with bend springs (10.8 and 11.3) 0.26; with tethers 0.37, 0.48, 0.56 and 0.65 for 16, 32, 64 and 128 a side,
// with bend springs 0.21, 0.29 and 0.39.
double largest_load(const SpringNetwork& network, const Body& body, const SpringGraph& graph, const LoadCase& load_case) {
  double shortest = kInfinity;
  double shortest_at_pin = kInfinity;
  Index joined = kNone;
  std::vector<Index> pins;
  for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
    if (graph.at(i).empty()) continue;
    joined = i;
    if (network.is_fixed(i)) pins.push_back(i);
    for (const SpringGraph::Edge& edge : graph.at(i)) {
      const double length = network.springs.rest_length[edge.spring];
      shortest = std::min(shortest, length);
      if (network.is_fixed(i)) shortest_at_pin = std::min(shortest_at_pin, length);
    }
  }
  if (joined == kNone) return 0.0;
  const double ends_per_particle = static_cast<double>(count_ends(body, graph)) / body.particle_count;
  if (pins.empty()) return half_path(body, graph, joined) * ends_per_particle / shortest;
  const auto free = network.inverse_masses.segment(body.first_particle, body.particle_count).array() > 0.0;
  const double shared = static_cast<double>(free.count()) / static_cast<double>(pins.size());
  const double load = load_case.tethers ? farthest_from(body, graph, pins).springs : shared;
  const double spread = load_case.shared ? (load_case.tethers ? kTetheredShare : kShare) / ends_per_particle : ends_per_particle;
  return load * spread / shortest_at_pin;
}

}  // namespace sprung
