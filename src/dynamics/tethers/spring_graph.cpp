#include "dynamics/tethers/spring_graph.h"

#include <numeric>

namespace sprung {

SpringGraph::SpringGraph(const SpringNetwork& network, const std::vector<Index>& springs)
    : begin_(network.particle_count() + 1, 0), edges_(2 * springs.size()) {
  const Springs& all = network.springs;
  for (const Index s : springs) {
    ++begin_[all.first[s] + 1];
    ++begin_[all.second[s] + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<Index> next(begin_.begin(), begin_.end() - 1);
  for (const Index s : springs) {
    edges_[next[all.first[s]]++] = {s, all.second[s]};
    edges_[next[all.second[s]]++] = {s, all.first[s]};
  }
}

}  // namespace sprung
