// Who is joined to whom by some of a network's springs.
#pragma once

#include "network/spring_network.h"

#include <span>
#include <vector>

namespace sprung {

class SpringGraph {
 public:
  /// A spring as one of its ends sees it.
  struct Way {
    Index spring;
    Index to;  ///< the particle at the other end
  };

  /// Of the springs with these numbers, each of which both its ends see.
  SpringGraph(const SpringNetwork& network, const std::vector<Index>& springs);

  /// The ways from a particle, in the order in which the springs were given.
  [[nodiscard]] std::span<const Way> at(Index particle) const {
    const auto i = static_cast<std::size_t>(particle);
    return {ways_.begin() + begin_[i], ways_.begin() + begin_[i + 1]};
  }

 private:
  std::vector<Index> begin_;  ///< of each particle in ways_
  std::vector<Way> ways_;
};

}  // namespace sprung
