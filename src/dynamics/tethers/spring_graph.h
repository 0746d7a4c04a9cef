// The graph of some of a network's springs.
#pragma once

#include "network/model/spring_network.h"

#include <span>
#include <vector>

namespace sprung {

class SpringGraph {
 public:
  /// An edge of the graph as one of its ends sees it.
  struct Edge {
    Index spring;
    Index to;  ///< the particle at the other end
  };

  /// The graph of the springs with these numbers.
  SpringGraph(const SpringNetwork& network, const std::vector<Index>& springs);

  /// The edges of a particle, in the order in which the springs were given.
  [[nodiscard]] std::span<const Edge> at(Index particle) const {
    const auto i = static_cast<std::size_t>(particle);
    return {edges_.begin() + begin_[i], edges_.begin() + begin_[i + 1]};
  }

 private:
  std::vector<Index> begin_;  ///< start of each particle in edges_
  std::vector<Edge> edges_;
};

}  // namespace sprung
