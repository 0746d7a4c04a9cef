#include "collision/impact_zones/division_planes.h"

#include "base/parallel.h"
#include "collision/impact_zones/pin_rigid_fit.h"

#include <algorithm>
#include <numeric>

namespace sprung {
namespace {

// As a part of the largest coordinate: above what the rounding of heights along a normal may lose.
constexpr double kClearance = 0x1p-30;

// How far from where its group takes it a pin may go, as a part of its pair's gap.
constexpr double kOfPins = 0.25;

// Times that those give way, and what is then near them: from where their groups take them, and as often again from rest. What then
// still passes is told.
constexpr int kRoundsEach = 3;

constexpr Index kPairsPerTask = 2048;

std::vector<DivisionPlanes::Bound> sorted(const std::vector<DivisionPlanes::Bound>& bounds, Index particles) {
  std::vector<std::size_t> next(static_cast<std::size_t>(particles) + 1, 0);
  for (const DivisionPlanes::Bound& bound : bounds) ++next[static_cast<std::size_t>(bound.particle) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<DivisionPlanes::Bound> result(bounds.size());
  for (const DivisionPlanes::Bound& bound : bounds) result[next[static_cast<std::size_t>(bound.particle)]++] = bound;
  return result;
}

}  // namespace

DivisionPlanes::DivisionPlanes(const Points& before, const Points& targets, const std::vector<char>& pinned,
                               const ParticleDisplacements& carriers, double kept)
    : before_(before),
      targets_(targets),
      pinned_(pinned),
      groups_(before, targets, pinned, carriers),
      ends_(targets),
      rule_{.thickness_kept = kept, .clearance = kClearance * before.cwiseAbs().maxCoeff()},
      way_(before, pinned, rule_),
      is_aside_(static_cast<std::size_t>(before.cols()), 0) {}

bool DivisionPlanes::hold(std::vector<ContactStencil>& pairs) {
  bool changed = false;
  passing_.clear();
  for (const Index k : find_passing(pairs, [&](const ContactStencil& pair) { return passes(pair); })) {
    const ContactStencil& pair = pairs[static_cast<std::size_t>(k)];
    changed = groups_.unite({pair.particles.data(), static_cast<std::size_t>(pair.count())}) || changed;
    note_passing(pair);
  }
  if (!changed) return false;
  groups_.find_motions();
  limit_groups(pairs);
  for (const Index i : groups_.particles()) ends_.col(i) = groups_.end(i);
  return true;
}

void DivisionPlanes::renew_normals(std::vector<ContactStencil>& pairs) const {
  parallel_chunks(static_cast<Index>(pairs.size()), kPairsPerTask, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      ContactStencil& pair = pairs[static_cast<std::size_t>(k)];
      if (!(heights_at(pair, before_).gap() > 0.0)) pair.normal = separating_direction(pair, before_);
    }
  });
}

template <class Passes>
std::vector<Index> DivisionPlanes::find_passing(std::vector<ContactStencil>& pairs, const Passes& passes) const {
  const auto count = static_cast<Index>(pairs.size());
  std::vector<std::vector<Index>> parts(static_cast<std::size_t>((count + kPairsPerTask - 1) / kPairsPerTask));
  parallel_chunks(count, kPairsPerTask, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      ContactStencil& pair = pairs[static_cast<std::size_t>(k)];
      if (!(heights_at(pair, ends_).gap() < rule_.least())) continue;
      pair.normal = separating_direction(pair, before_);
      if (passes(pair) && !is_carried(pair)) parts[static_cast<std::size_t>(begin / kPairsPerTask)].push_back(k);
    }
  });
  std::vector<Index> passing;
  for (const std::vector<Index>& part : parts) passing.insert(passing.end(), part.begin(), part.end());
  return passing;
}

/// A turn by less than a right angle leaves seven tenths of the gap, whatever normal that was along.
bool DivisionPlanes::is_carried(const ContactStencil& pair) const {
  std::vector<PinDisplacement> ways;
  for (int k = 0; k < pair.count(); ++k) {
    const Index i = pair.particles[static_cast<std::size_t>(k)];
    if (!is_pinned(i)) return false;
    ways.push_back({before_.col(i), targets_.col(i)});
  }
  const auto motion = common_turn(ways);
  const double gap = heights_at(pair, before_).gap();
  return motion && std::ranges::all_of(
                       ways, [&](const PinDisplacement& way) { return (*motion * way.from - way.to).norm() <= kOfPins * gap; });
}

void DivisionPlanes::note_passing(const ContactStencil& pair) {
  passing_.insert(passing_.end(), pair.particles.begin(), pair.particles.begin() + pair.count());
}

bool DivisionPlanes::give_way(std::vector<ContactStencil>& pairs) {
  gives_way_ = true;
  passing_.clear();
  const auto passes = [&](const ContactStencil& pair) { return way_.passes(pair, ends_); };
  for (const Index k : find_passing(pairs, passes)) note_passing(pairs[static_cast<std::size_t>(k)]);
  if (passing_.empty() || ++rounds_ > 2 * kRoundsEach) return false;
  if (rounds_ == kRoundsEach + 1) begin_at_rest();
  for (const Index i : way_.move_apart(pairs, ends_)) {
    if (is_held(i)) continue;
    is_aside_[static_cast<std::size_t>(i)] = 1;
    aside_.push_back(i);
  }
  return true;
}

/// Groups of sides that pass each other begin where they are: what they have in common with some of their pins is not what others
/// leave them.
void DivisionPlanes::begin_at_rest() {
  std::vector<Index> drawn;
  for (const Index i : passing_) {
    if (groups_.holds(i)) drawn.push_back(groups_.group(i));
  }
  std::sort(drawn.begin(), drawn.end());
  for (const Index i : groups_.particles()) {
    if (std::binary_search(drawn.begin(), drawn.end(), groups_.group(i))) ends_.col(i) = before_.col(i);
  }
}

std::vector<Index> DivisionPlanes::held() const {
  std::vector<Index> held = groups_.particles();
  held.insert(held.end(), aside_.begin(), aside_.end());
  return held;
}

std::vector<Index> DivisionPlanes::taken_along() const {
  std::vector<Index> taken = groups_.particles();
  std::erase_if(taken, [&](Index i) { return !groups_.is_anchored(groups_.group(i)); });
  return taken;
}

/// Whether the sides end nearer than they ever may. What touched when the step began has no plane to keep, what moves rigidly needs
/// none.
bool DivisionPlanes::passes(const ContactStencil& pair) const {
  const double begun = heights_at(pair, before_).gap();
  if (!(begun > 0.0)) return false;
  const Index group = group_of(pair, begun);
  const bool has_pins =
      std::any_of(pair.particles.begin(), pair.particles.begin() + pair.count(), [&](Index i) { return is_pinned(i); });
  if (group != kNone && groups_.fraction(group) == 0.0 && !has_pins) return false;
  const double end = heights_at(turned(pair, group), ends_).gap();
  return end < rule_.needed(begun);
}

ContactStencil DivisionPlanes::turned(ContactStencil pair, Index group) const {
  pair.normal = groups_.carried(group, pair.normal).end.normalized();
  return pair;
}

// On straight ways a turn by less than a right angle leaves seven tenths of a gap, the strain of an anchored group half of it: a
// quarter is a pin's to go elsewhere.
Index DivisionPlanes::group_of(const ContactStencil& pair, double gap) const {
  Index group = kNone;
  for (int k = 0; k < pair.count(); ++k) group = std::max(group, groups_.group(pair.particles[static_cast<std::size_t>(k)]));
  const auto is_of = [&](Index i) {
    return groups_.group(i) == group || (is_pinned(i) && groups_.takes_along(group, i, kOfPins * gap));
  };
  return std::all_of(pair.particles.begin(), pair.particles.begin() + pair.count(), is_of) ? group : kNone;
}

/// Along their ways the gap of a group's pair is at least the linear function between its values at both ends.
void DivisionPlanes::limit_groups(const std::vector<ContactStencil>& pairs) {
  for (const ContactStencil& pair : pairs) {
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
    const double kept = rule_.kept(heights_at(pair, before_).gap());
    if (!(at_target < kept)) continue;
    const double at_start =
        heights_of(pair, [&](int k) { return pair.normal.dot(groups_.start(pair.particles[static_cast<std::size_t>(k)])); }).gap();
    groups_.limit_fraction(group, std::clamp((at_start - kept) / (at_start - at_target), 0.0, 1.0));
  }
}

std::vector<DivisionPlanes::Bound> DivisionPlanes::bounds(const std::vector<ContactStencil>& pairs) const {
  std::vector<Bound> found;
  for (const ContactStencil& pair : pairs) {
    if (std::none_of(pair.particles.begin(), pair.particles.begin() + pair.count(), [&](Index i) { return is_held(i); })) continue;
    const double begun = heights_at(pair, before_).gap();
    if (!(begun > 0.0)) continue;
    if (gives_way_) {
      append_bounds(pair, *way_.plane(pair, ends_), found);
    } else {
      append_bounds(pair, groups_.carried(group_of(pair, begun), pair.normal), found);
    }
  }
  return sorted(found, static_cast<Index>(before_.cols()));
}

void DivisionPlanes::append_bounds(const ContactStencil& pair, const RotatingPlane& plane, std::vector<Bound>& found) const {
  append_bounds(pair, plane.end, Vector3::Zero(), found);
  if (plane.end != plane.begin) append_bounds(pair, plane.begin, plane.end, found);
}

void DivisionPlanes::append_bounds(const ContactStencil& pair, const MovedPlane& plane, std::vector<Bound>& found) const {
  append_bounds(pair, plane.end, Vector3::Zero(), found);
  if (plane.stays()) return;
  append_bounds(pair, plane.begin, 2.0 * plane.middle, found);
  append_bounds(pair, 2.0 * plane.middle, plane.end, found);
}

/// Bounds of what `after` . x1 + `earlier` . x0 is of each particle.
void DivisionPlanes::append_bounds(const ContactStencil& pair, const Vector3& after, const Vector3& earlier,
                                   std::vector<Bound>& found) const {
  const double length = after.norm();
  const Vector3 normal = after / length;
  const auto extra = [&](Index i) { return earlier.dot(before_.col(i)) / length; };
  const auto heights = [&](const Points& x) {
    return heights_of(pair, [&](int k) {
      const Index i = pair.particles[static_cast<std::size_t>(k)];
      return normal.dot(x.col(i)) + extra(i);
    });
  };
  const double room = 0.5 * rule_.kept(heights_at(pair, before_).gap());
  const SideHeights end = heights(ends_);
  const SideHeights target = heights(targets_);
  const double least = 0.5 * std::clamp(end.gap(), 0.0, rule_.least());
  const double highest = std::max(end.first, end.second) - least;
  const double middle = std::max(end.second + least, std::min(0.5 * (target.first + target.second), highest));
  const double above = std::min(end.first, middle + room);
  const double below = std::max(end.second, middle - room);
  for (int k = 0; k < pair.count(); ++k) {
    const Index i = pair.particles[static_cast<std::size_t>(k)];
    if (!is_held(i)) continue;
    found.push_back(k < pair.first_count ? Bound{i, {normal, above - extra(i)}} : Bound{i, {-normal, extra(i) - below}});
  }
}

}  // namespace sprung
