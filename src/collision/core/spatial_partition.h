// Groups of neighbouring points: a set is halved across its longest extent until each group is small.
#pragma once

#include "base/types.h"

#include <cstddef>
#include <vector>

namespace sprung {

/// Sorts order[begin, end), which are columns of `middles` [m], into consecutive groups of neighbours; within a group they ascend.
/// The groups are as few as possible with at most `most` members, and nearly equal in size. Appends the begin of each group. The
/// first half of the groups is separated from the second by the first cut, and so on, so that a balanced tree over the groups
/// bounds neighbours. Requires most > 0.
void bisect(const Points& middles, std::size_t most, std::vector<Index>& order, std::size_t begin, std::size_t end,
            std::vector<std::size_t>& starts);

}  // namespace sprung
