// Groups of neighbours: points are cut in halves across their longest extent until few are left in each.
#pragma once

#include "base/types.h"

#include <cstddef>
#include <vector>

namespace sprung {

/// Orders order[begin, end), which are columns of `middles` [m], so that the fewest groups of at most `most` that can hold them
/// follow each other, of nearly equal size; within a group by number. Appends where each group begins. The first half of the groups
/// was cut from the second first, and so on: a balanced tree over them bounds neighbours. Requires most > 0.
void bisect(const Points& middles, std::size_t most, std::vector<Index>& order, std::size_t begin, std::size_t end,
            std::vector<std::size_t>& starts);

}  // namespace sprung
