#include "dynamics/stretch_load.h"

#include <algorithm>
#include <limits>
#include <set>

namespace sprung {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Particles of a body and who their neighbours along limited springs are.
class Neighbours {
 public:
  Neighbours(const Body& body, const StretchBatches& batches, const std::vector<Index>& springs)
      : begin_(body.particle_count + 1, 0), neighbour_(2 * springs.size()) {
    for (const Index s : springs) {
      ++begin_[batches.first[s] - body.first_particle + 1];
      ++begin_[batches.second[s] - body.first_particle + 1];
    }
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    std::vector<Index> next(begin_.begin(), begin_.end() - 1);
    for (const Index s : springs) {
      const Index a = batches.first[s] - body.first_particle;
      const Index b = batches.second[s] - body.first_particle;
      neighbour_[next[a]++] = b;
      neighbour_[next[b]++] = a;
    }
  }

  struct Farthest {
    Index particle;
    Index springs;  ///< on the way there
  };

  /// Counted from the nearest of `starts`.
  [[nodiscard]] Farthest farthest_from(const std::vector<Index>& starts) const {
    std::vector<Index> away(begin_.size() - 1, kNone);
    std::vector<Index> queue = starts;
    for (const Index start : starts) away[start] = 0;
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const Index i = queue[head];
      for (Index k = begin_[i]; k < begin_[i + 1]; ++k) {
        const Index other = neighbour_[k];
        if (away[other] != kNone) continue;
        away[other] = away[i] + 1;
        queue.push_back(other);
      }
    }
    return {queue.back(), away[queue.back()]};
  }

 private:
  std::vector<Index> begin_;
  std::vector<Index> neighbour_;
};

std::vector<Index> springs_of(const Body& body, const StretchBatches& batches) {
  std::vector<Index> springs;
  for (Index s = 0; s < batches.count(); ++s) {
    const Index particle = batches.first[s] - body.first_particle;
    const bool repeated = s > 0 && batches.first[s] == batches.first[s - 1] && batches.second[s] == batches.second[s - 1];
    if (particle >= 0 && particle < body.particle_count && !repeated) springs.push_back(s);
  }
  return springs;
}

/// Half the springs on the way between two ends of the body that are far apart.
double half_way(const Body& body, const StretchBatches& batches, const std::vector<Index>& springs) {
  const Neighbours neighbours(body, batches, springs);
  const Index end = neighbours.farthest_from({batches.first[springs.front()] - body.first_particle}).particle;
  return 0.5 * neighbours.farthest_from({end}).springs;
}

/// Springs on the way from the particle that is farthest from all pins.
double longest_strand(const Body& body, const StretchBatches& batches, const std::vector<Index>& springs,
                      const std::set<Index>& pins) {
  std::vector<Index> starts;
  for (const Index pin : pins) starts.push_back(pin - body.first_particle);
  return Neighbours(body, batches, springs).farthest_from(starts).springs;
}

}  // namespace

// Passes spread excess like diffusion: what moves down by u at n particles leaves on average n u / d at the pin. But a spring has
// none right after its own projection, and its neighbours' take turns in adding some again: the last of those that meet at a
// particle holds what all of them hold on average. Hanging ropes, 2 springs a particle, showed 1.8 to 1.9 times the average,
// cloths, 4 springs, 4.0 times.
//
// Tethers hand on at once what hangs straight from a pin; what hangs askew its strand still carries. Cloths of 24, 48 and 64
// particles a side, by two corners, one pass a step, showed 0.8, 0.8 and 0.6 of what a rope of so many springs would.
double largest_load(const SpringNetwork& network, const Body& body, const StretchBatches& batches, bool tethers) {
  const std::vector<Index> springs = springs_of(body, batches);
  if (springs.empty()) return 0.0;
  double shortest = kInfinity;
  double shortest_at_pin = kInfinity;
  std::set<Index> pins;
  for (const Index s : springs) {
    shortest = std::min(shortest, batches.rest_length[s]);
    for (const Index end : {batches.first[s], batches.second[s]}) {
      if (!network.is_pinned(end)) continue;
      shortest_at_pin = std::min(shortest_at_pin, batches.rest_length[s]);
      pins.insert(end);
    }
  }
  const double meeting = 2.0 * static_cast<double>(springs.size()) / body.particle_count;
  if (pins.empty()) return half_way(body, batches, springs) * meeting / shortest;
  const auto free = network.inverse_masses.segment(body.first_particle, body.particle_count).array() > 0.0;
  const double shared = static_cast<double>(free.count()) / static_cast<double>(pins.size());
  const double carried = tethers ? longest_strand(body, batches, springs, pins) : shared;
  return carried * meeting / shortest_at_pin;
}

}  // namespace sprung
