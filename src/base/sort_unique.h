// Sorted lists without duplicates.
#pragma once

#include <algorithm>
#include <vector>

namespace sprung {

/// Sorts the items, and keeps one of those that are equal.
template <class Item>
void sort_unique(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace sprung
