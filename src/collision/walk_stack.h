// The stack of a walk through a tree: on the call stack for trees of usual depth, on the heap for hostile ones.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sprung {

/// A node (>= 0) or leaf (~leaf) still to visit, and a lower bound that may rule it out by then.
struct WalkEntry {
  float bound;
  std::int32_t child;
};

class WalkStack {
 public:
  explicit WalkStack(std::size_t capacity) {
    if (capacity > local_.size()) {
      heap_.resize(capacity);
      entries_ = heap_.data();
    }
  }
  WalkStack(const WalkStack&) = delete;
  WalkStack& operator=(const WalkStack&) = delete;

  [[nodiscard]] bool empty() const { return size_ == 0; }
  void push(WalkEntry entry) { entries_[size_++] = entry; }
  WalkEntry pop() { return entries_[--size_]; }

  /// Pushes an entry below those pushed since `base` whose bound is smaller, so that the smallest is popped first.
  void push_sorted(WalkEntry entry, std::size_t base) {
    std::size_t place = size_++;
    for (; place > base && entries_[place - 1].bound < entry.bound; --place) entries_[place] = entries_[place - 1];
    entries_[place] = entry;
  }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::array<WalkEntry, 256> local_;
  std::vector<WalkEntry> heap_;
  WalkEntry* entries_ = local_.data();
  std::size_t size_ = 0;
};

}  // namespace sprung
