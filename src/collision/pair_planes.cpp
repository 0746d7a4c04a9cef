#include "collision/pair_planes.h"

#include "base/parallel.h"

#include <algorithm>
#include <numeric>

namespace sprung {
namespace {

// As a part of the largest coordinate: above what the rounding of heights along a normal may lose.
constexpr double kClearance = 0x1p-30;

// What a step may do by rounding to a gap, as a part of the clearance.
constexpr double kRounding = 0x1p-18;

// How far from where its group takes it a pin may go, as a part of its pair's gap.
constexpr double kOfPins = 0.25;

constexpr Index kPairsPerTask = 2048;

std::vector<PairPlanes::Bound> sorted(const std::vector<PairPlanes::Bound>& bounds, Index particles) {
  std::vector<std::size_t> next(static_cast<std::size_t>(particles) + 1, 0);
  for (const PairPlanes::Bound& bound : bounds) ++next[static_cast<std::size_t>(bound.particle) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<PairPlanes::Bound> result(bounds.size());
  for (const PairPlanes::Bound& bound : bounds) result[next[static_cast<std::size_t>(bound.particle)]++] = bound;
  return result;
}

}  // namespace

PairPlanes::PairPlanes(const Points& before, const Points& targets, const std::vector<char>& pinned, const Carriers& carriers,
                       double kept)
    : before_(before),
      targets_(targets),
      pinned_(pinned),
      groups_(before, targets, pinned, carriers),
      ends_(targets),
      kept_(kept),
      clearance_(kClearance * before.cwiseAbs().maxCoeff()) {}

bool PairPlanes::hold(std::vector<ElementPair>& pairs) {
  bool changed = false;
  passing_.clear();
  for (const Index k : find_conflicts(pairs)) {
    const ElementPair& pair = pairs[static_cast<std::size_t>(k)];
    const std::span<const Index> particles(pair.particles.data(), static_cast<std::size_t>(pair.count()));
    changed = groups_.unite(particles) || changed;
    passing_.insert(passing_.end(), particles.begin(), particles.end());
  }
  if (!changed) return false;
  groups_.find_motions();
  limit_groups(pairs);
  for (const Index i : groups_.particles()) ends_.col(i) = groups_.end(i);
  return true;
}

void PairPlanes::renew_normals(std::vector<ElementPair>& pairs) const {
  parallel_chunks(static_cast<Index>(pairs.size()), kPairsPerTask, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      ElementPair& pair = pairs[static_cast<std::size_t>(k)];
      if (!(heights_at(pair, before_).gap() > 0.0)) pair.normal = direction_between(pair, before_);
    }
  });
}

std::vector<Index> PairPlanes::find_conflicts(std::vector<ElementPair>& pairs) const {
  const auto count = static_cast<Index>(pairs.size());
  std::vector<std::vector<Index>> parts(static_cast<std::size_t>((count + kPairsPerTask - 1) / kPairsPerTask));
  parallel_chunks(count, kPairsPerTask, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      ElementPair& pair = pairs[static_cast<std::size_t>(k)];
      if (!(heights_at(pair, ends_).gap() < least_gap())) continue;
      pair.normal = direction_between(pair, before_);
      if (passes(pair)) parts[static_cast<std::size_t>(begin / kPairsPerTask)].push_back(k);
    }
  });
  std::vector<Index> conflicts;
  for (const std::vector<Index>& part : parts) conflicts.insert(conflicts.end(), part.begin(), part.end());
  return conflicts;
}

/// Whether the sides end nearer than they ever may. What touched when the step began has no plane to keep, what moves rigidly needs
/// none.
bool PairPlanes::passes(const ElementPair& pair) const {
  const double begun = heights_at(pair, before_).gap();
  if (!(begun > 0.0)) return false;
  const Index group = group_of(pair, begun);
  const bool has_pins =
      std::any_of(pair.particles.begin(), pair.particles.begin() + pair.count(), [&](Index i) { return is_pinned(i); });
  if (group != kNone && groups_.fraction(group) == 0.0 && !has_pins) return false;
  const double end = heights_at(turned(pair, group), ends_).gap();
  return end < std::min(begun, least_gap()) - kRounding * clearance_;
}

ElementPair PairPlanes::turned(ElementPair pair, Index group) const {
  if (group != kNone) pair.normal = groups_.turned(group, pair.normal);
  return pair;
}

// On straight ways a turn by less than a right angle leaves seven tenths of a gap, the strain of an anchored group half of it: a
// quarter is a pin's to go elsewhere.
Index PairPlanes::group_of(const ElementPair& pair, double gap) const {
  Index group = kNone;
  for (int k = 0; k < pair.count(); ++k) group = std::max(group, groups_.group(pair.particles[static_cast<std::size_t>(k)]));
  const auto is_of = [&](Index i) {
    return groups_.group(i) == group || (is_pinned(i) && groups_.takes_along(group, i, kOfPins * gap));
  };
  return std::all_of(pair.particles.begin(), pair.particles.begin() + pair.count(), is_of) ? group : kNone;
}

double PairPlanes::kept_gap(const ElementPair& pair) const {
  const double begun = heights_at(pair, before_).gap();
  return std::min(begun, std::max(clearance_, kept_));
}

/// Along their ways the gap of a group's pair is at least the linear function between its values at both ends.
void PairPlanes::limit_groups(const std::vector<ElementPair>& pairs) {
  for (const ElementPair& pair : pairs) {
    Index group = kNone;
    bool inner = true;
    for (int k = 0; k < pair.count(); ++k) {
      const Index own = groups_.group(pair.particles[static_cast<std::size_t>(k)]);
      if (own == kNone) continue;
      inner = inner && (group == kNone || own == group);
      group = own;
    }
    if (group == kNone || !inner) continue;
    const double at_target = heights_at(pair, targets_).gap();
    const double kept = kept_gap(pair);
    if (!(at_target < kept)) continue;
    const double at_start =
        heights_of(pair, [&](int k) { return pair.normal.dot(groups_.start(pair.particles[static_cast<std::size_t>(k)])); }).gap();
    groups_.limit_fraction(group, std::clamp((at_start - kept) / (at_start - at_target), 0.0, 1.0));
  }
}

std::vector<PairPlanes::Bound> PairPlanes::bounds(const std::vector<ElementPair>& pairs) const {
  std::vector<Bound> found;
  for (ElementPair pair : pairs) {
    if (std::none_of(pair.particles.begin(), pair.particles.begin() + pair.count(), [&](Index i) { return groups_.holds(i); }))
      continue;
    const double begun = heights_at(pair, before_).gap();
    if (!(begun > 0.0)) continue;
    const double room = 0.5 * kept_gap(pair);
    pair = turned(pair, group_of(pair, begun));
    const PairHeights end = heights_at(pair, ends_);
    const PairHeights target = heights_at(pair, targets_);
    const double least = 0.5 * std::clamp(end.gap(), 0.0, least_gap());
    const double highest = std::max(end.first, end.second) - least;
    const double middle = std::max(end.second + least, std::min(0.5 * (target.first + target.second), highest));
    const HalfSpace above{pair.normal, std::min(end.first, middle + room)};
    const HalfSpace below{-pair.normal, -std::max(end.second, middle - room)};
    for (int k = 0; k < pair.count(); ++k) {
      const Index i = pair.particles[static_cast<std::size_t>(k)];
      if (groups_.holds(i)) found.push_back({i, k < pair.first_count ? above : below});
    }
  }
  return sorted(found, static_cast<Index>(before_.cols()));
}

}  // namespace sprung
