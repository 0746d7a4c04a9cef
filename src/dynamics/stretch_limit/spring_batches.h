// The springs of a stretch limit in batches without common particles.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Entry s of each array belongs to limited spring s. The springs of a batch are contiguous. The last spring of a gathered batch is
/// repeated to fill a multiple of kSimdWidth.
struct SpringBatches {
  std::vector<Index> spring;  ///< of the network
  std::vector<Index> first;
  std::vector<Index> second;
  std::vector<double> rest_length;  ///< d [m], > 0
  std::vector<double> per_length;   ///< 1 / d [1/m]
  std::vector<double> first_share;  ///< fraction of a correction that the first end takes: w_1 / (w_1 + w_2) with inverse masses w

  /// How the particles of a batch's springs lie in memory.
  enum class Layout : std::uint8_t {
    runs,     ///< in each group of kWideSimdWidth, from s on, spring s + i joins first[s] + i and second[s] + i
    gathered  ///< arbitrary
  };

  /// Springs [begin, end), at most kBatchSprings.
  struct Batch {
    Index begin;
    Index end;
    Layout layout;
    bool same;  ///< all springs have the constants of the first
  };
  static constexpr Index kBatchSprings = 64;
  std::vector<Batch> batch;

  /// Task t takes batches [task_begin[t], task_begin[t + 1]) in order. Stage s holds tasks [stage_begin[s], stage_begin[s + 1]),
  /// no two of which share a particle. The bits are those of one colour of springs after the other.
  std::vector<Index> task_begin{0};
  std::vector<Index> stage_begin{0};

  /// Springs of the given kinds that have a rest length and at least one free end.
  SpringBatches(const SpringNetwork& network, const std::vector<SpringKind>& kinds);

  [[nodiscard]] Index count() const { return static_cast<Index>(first.size()); }
};

}  // namespace sprung
