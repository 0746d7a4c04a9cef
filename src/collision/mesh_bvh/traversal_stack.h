// For traversals of a mesh BVH: boxes in single precision, rounded outward, and a stack, which is in the object itself for trees of
// usual depth, on the heap for very deep ones.
#pragma once

#include "base/machine/simd.h"
#include "base/types.h"
#include "collision/mesh_bvh/mesh_bvh.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace sprung {

/// A float above or below the value, by one or two roundings; near 0 by the smallest normal float. It is finite, so that the
/// infinite bounds of a node's unused lanes are apart from it.
[[nodiscard]] inline float float_above(double value) {
  constexpr float kMost = std::numeric_limits<float>::max();
  const auto nearest = static_cast<float>(value);
  const float above = nearest + (std::abs(nearest) * 0x1p-23F + std::numeric_limits<float>::min());
  return above < kMost ? above : kMost;
}
[[nodiscard]] inline float float_below(double value) { return -float_above(-value); }

struct FloatBox {
  float min[3];
  float max[3];
};

/// A box that contains `box`.
[[nodiscard]] inline FloatBox float_box(const Box3& box) {
  FloatBox rounded;
  for (int axis = 0; axis < 3; ++axis) {
    rounded.min[axis] = float_below(box.min()[axis]);
    rounded.max[axis] = float_above(box.max()[axis]);
  }
  return rounded;
}

/// A node (>= 0) or block (~block) to visit, and a lower bound of its distance, which may exclude it by then.
struct TraversalEntry {
  float bound;
  std::int32_t child;
};

class TraversalStack {
 public:
  explicit TraversalStack(std::size_t capacity) {
    if (capacity > local_.size()) {
      heap_.resize(capacity);
      entries_ = heap_.data();
    }
  }
  TraversalStack(const TraversalStack&) = delete;
  TraversalStack& operator=(const TraversalStack&) = delete;

  [[nodiscard]] bool empty() const { return size_ == 0; }
  void push(TraversalEntry entry) { entries_[size_++] = entry; }
  TraversalEntry pop() { return entries_[--size_]; }

  /// Pushes the children whose bound is at most `limit`. The smallest comes last; the others have no order. Sorting them, or
  /// testing each before it is written, costs more in mispredicted branches than it saves in visits. Writes up to kFloatSimdWidth
  /// entries past the top.
  [[gnu::always_inline]] void push_within(const Float8& bounds, const std::int32_t* children, float limit) {
    const std::size_t base = size_;
    for (int lane = 0; lane < kFloatSimdWidth; ++lane) {
      entries_[size_] = {bounds[lane], children[lane]};
      size_ += bounds[lane] <= limit ? 1 : 0;
    }
    if (size_ == base) return;
    std::size_t smallest = base;
    for (std::size_t i = base + 1; i < size_; ++i) smallest = entries_[i].bound < entries_[smallest].bound ? i : smallest;
    std::swap(entries_[smallest], entries_[size_ - 1]);
  }

 private:
  std::array<TraversalEntry, 256> local_;
  std::vector<TraversalEntry> heap_;
  TraversalEntry* entries_ = local_.data();
  std::size_t size_ = 0;
};

/// Pushes the children whose boxes intersect the box.
void push_intersecting(const MeshBvh::Node& node, const FloatBox& box, TraversalStack& stack);

/// Calls `visit(number)` for each block whose box intersects the box, or is close to it.
template <class Visit>
void visit_blocks(const MeshBvh& tree, const Box3& box, const Visit& visit) {
  const FloatBox bounds = float_box(box);
  TraversalStack stack(tree.stack_size());
  stack.push({0.0F, 0});
  while (!stack.empty()) {
    const std::int32_t child = stack.pop().child;
    if (child < 0) {
      visit(~child);
    } else {
      push_intersecting(tree.node(child), bounds, stack);
    }
  }
}

}  // namespace sprung
