// Sleep groups: neighbouring particles that fall asleep and wake together.
#pragma once

#include "network/model/spring_network.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace sprung {

struct SleepGroup {
  std::size_t body = 0;
  std::vector<Index> particles;  ///< ascending
  std::vector<Index> reached;    ///< these, and those that share a face or segment with one of them
};

/// Two groups, the first of lower number.
using GroupPair = std::pair<Index, Index>;

struct SleepGroups {
  std::vector<SleepGroup> groups;
  std::vector<Index> group_of;      ///< by particle
  std::vector<GroupPair> adjacent;  ///< of the same body, that springs, bends, faces or segments join; ascending

  /// The groups of bodies are divided by their positions at time 0, so that they stay the same when springs break. A body with
  /// cells, or with a volume that passes keep, is one group.
  explicit SleepGroups(const SpringNetwork& network);

  [[nodiscard]] Index count() const { return static_cast<Index>(groups.size()); }

 private:
  void divide(const SpringNetwork& network);
  void find_adjacent(const SpringNetwork& network);
  void reach(Index particle, Index other);
  void join(Index particle, Index other);
};

/// Whether each group is marked, or in a pair with a marked one.
[[nodiscard]] std::vector<char> with_neighbours(const std::vector<char>& marked, const std::vector<GroupPair>& pairs);

}  // namespace sprung
