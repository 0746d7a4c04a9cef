#include "simulation/sleep/sleep_group.h"

#include "base/sort_unique.h"
#include "collision/core/block_bounds.h"

#include <algorithm>
#include <numeric>

namespace sprung {
namespace {

// 8 x 8 particles of a cloth. Smaller groups fall asleep and wake more often, which costs as much as ten steps each time.
constexpr std::size_t kMostParticles = 64;

}  // namespace

SleepGroups::SleepGroups(const SpringNetwork& network) : group_of(static_cast<std::size_t>(network.particle_count()), kNone) {
  divide(network);
  find_adjacent(network);
}

void SleepGroups::divide(const SpringNetwork& network) {
  std::vector<Index> order(group_of.size());
  std::iota(order.begin(), order.end(), Index{0});
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    const Body& body = network.bodies[b];
    const auto begin = static_cast<std::size_t>(body.first_particle);
    const auto particles = static_cast<std::size_t>(body.particle_count);
    if (particles == 0) continue;
    const bool whole = !body.cells.empty() || body.volume_factor != 0.0;
    std::vector<std::size_t> starts;
    bisect(network.positions, whole ? particles : kMostParticles, order, begin, begin + particles, starts);
    starts.push_back(begin + particles);
    for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
      SleepGroup& group = groups.emplace_back();
      group.body = b;
      for (std::size_t i = starts[k]; i < starts[k + 1]; ++i) {
        group.particles.push_back(order[i]);
        group_of[order[i]] = count() - 1;
      }
      group.reached = group.particles;
    }
  }
}

void SleepGroups::find_adjacent(const SpringNetwork& network) {
  const Springs& springs = network.springs;
  for (Index s = 0; s < springs.count(); ++s) join(springs.first[s], springs.second[s]);
  const AngleBends& bends = network.angle_bends;
  for (Index e = 0; e < bends.count(); ++e) {
    join(bends.before[e], bends.middle[e]);
    join(bends.middle[e], bends.after[e]);
    join(bends.before[e], bends.after[e]);
  }
  for (Index f = 0; f < network.face_bends.count(); ++f) {
    const BendStencil stencil = stencil_of(network.face_bends, network.hinges, f);
    for (std::size_t i = 0; i < stencil.particles.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) join(stencil.particles[i], stencil.particles[j]);
    }
  }
  for (const Body& body : network.bodies) {
    const Index first = body.first_particle;
    for (const auto& corners : body.surface.triangles.colwise()) {
      for (int k = 0; k < 3; ++k) reach(first + corners[k], first + corners[(k + 1) % 3]);
    }
    for (const auto& ends : body.surface.segments.colwise()) reach(first + ends[0], first + ends[1]);
  }
  sort_unique(adjacent);
  for (SleepGroup& group : groups) sort_unique(group.reached);
}

void SleepGroups::reach(Index particle, Index other) {
  if (group_of[particle] == group_of[other]) return;
  groups[group_of[particle]].reached.push_back(other);
  groups[group_of[other]].reached.push_back(particle);
  join(particle, other);
}

void SleepGroups::join(Index particle, Index other) {
  const auto [first, second] = std::minmax(group_of[particle], group_of[other]);
  if (first != second) adjacent.emplace_back(first, second);
}

std::vector<char> with_neighbours(const std::vector<char>& marked, const std::vector<GroupPair>& pairs) {
  std::vector<char> result = marked;
  for (const auto& [a, b] : pairs) {
    if (marked[a] != 0) result[b] = 1;
    if (marked[b] != 0) result[a] = 1;
  }
  return result;
}

}  // namespace sprung
