// Elements by blocks of particles, so that several threads add forces of elements that share particles.
#pragma once

#include "base/parallel.h"
#include "base/types.h"
#include "network/model/spring_network.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace sprung {

/// One thread computes all elements that touch a block of particles. Elements across two blocks are computed twice. The sums do not
/// depend on the number of threads.
class ElementBlocks {
 public:
  explicit ElementBlocks(Index particles) : blocks_(static_cast<std::size_t>(particles / kParticles + 1)) {}

  /// Adds an element, unless all of its particles are asleep. Requires ascending elements.
  template <class Particles>
  void add(const SpringNetwork& network, Index element, const Particles& particles) {
    if (std::ranges::all_of(particles, [&](Index i) { return network.is_asleep(i); })) return;
    for (const Index particle : particles) {
      std::vector<Index>& block = blocks_[particle / kParticles];
      if (block.empty() || block.back() != element) block.push_back(element);
    }
  }

  /// Calls `function(element, add_to)` for each element; `add_to(particle, force)` adds to a column of `forces`, 3 x n.
  template <class Function>
  void for_each(Points& forces, const Function& function) const {
    parallel_chunks(static_cast<Index>(blocks_.size()), 1, [&](Index begin, Index end) {
      for (Index block = begin; block < end; ++block) {
        const auto add_to = [&](Index particle, const Vector3& force) {
          if (particle / kParticles == block) forces.col(particle) += force;
        };
        for (const Index element : blocks_[block]) function(element, add_to);
      }
    });
  }

 private:
  static constexpr Index kParticles = 2048;

  std::vector<std::vector<Index>> blocks_;
};

}  // namespace sprung
