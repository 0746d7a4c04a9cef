// The two keyframes between which a time lies.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace sprung {

/// Keyframes `before` and `after`, and the fraction of the time between them that has passed. Both are the same keyframe, with the
/// fraction 0, before the first one and after the last one.
struct KeyframeSpan {
  std::size_t before = 0;
  std::size_t after = 0;
  double fraction = 0.0;
};

/// The span of `keys` that contains `time` [s]. Requires at least one key; their member `time` increases strictly.
template <class Key>
[[nodiscard]] KeyframeSpan span_at(const std::vector<Key>& keys, double time) {
  const auto next = std::upper_bound(keys.begin(), keys.end(), time, [](double t, const Key& key) { return t < key.time; });
  const auto after = static_cast<std::size_t>(next - keys.begin());
  if (after == 0) return {};
  if (after == keys.size()) return {after - 1, after - 1, 0.0};
  const Key& a = keys[after - 1];
  return {after - 1, after, (time - a.time) / (keys[after].time - a.time)};
}

}  // namespace sprung
