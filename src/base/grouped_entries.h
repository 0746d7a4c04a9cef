// Entries grouped by the number of their owner, one group after the other.
#pragma once

#include "base/types.h"

#include <cstddef>
#include <vector>

namespace sprung {

/// Fills `entries` so that those of owner i are [first[i], first[i + 1]), in the order of the visit. `visit_all(add)` calls
/// `add(owner, entry)` for each entry; it is called twice and must make the same calls.
template <class Entry, class VisitAll>
void group_entries(std::size_t owners, const VisitAll& visit_all, std::vector<Index>& first, std::vector<Entry>& entries) {
  first.assign(owners + 1, 0);
  visit_all([&](Index owner, const Entry& /*entry*/) { ++first[static_cast<std::size_t>(owner) + 1]; });
  for (std::size_t i = 0; i < owners; ++i) first[i + 1] += first[i];
  entries.resize(static_cast<std::size_t>(first.back()));
  std::vector<Index> next = first;
  visit_all(
      [&](Index owner, const Entry& entry) { entries[static_cast<std::size_t>(next[static_cast<std::size_t>(owner)]++)] = entry; });
}

}  // namespace sprung
