#include "collision/patch_zones.h"

#include "collision/feasible_point.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

// A zone's box is this part of an element's size, or of the gap, larger than the element on each side: larger ones meet more
// triangles, smaller ones are left sooner.
constexpr double kReachOfSize = 0.25;
constexpr double kReachOfGap = 0.8;

// And as much larger as its corners are about to move, twice, since constraints move them farther.
constexpr double kReachOfMotion = 2.0;

// Nearest points are looked for again after a motion of this part of the gap: friction goes wrong with older ones.
constexpr double kFreshPart = 1.0;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

PatchZones::PatchZones(Index obstacle, const PatchTopology& topology)
    : obstacle_(obstacle),
      zones_(at(topology.element_count())),
      made_around_(zones_.size()),
      slots_(at(topology.slot_count())),
      marked_(zones_.size(), 0) {}

void PatchZones::follow(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths,
                        const ZoneDemand& demand) {
  travelled_ = shape.travelled();
  if (shape.deforms()) follow_surface(shape, topology, paths, demand);
  mark(topology, paths, demand);
  make_marked(shape, topology, paths, demand);
}

// Which way the surface came nearer is not asked: zones that it may have left too small to hold their element are made again.
void PatchZones::follow_surface(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths,
                                const ZoneDemand& demand) {
  for (Index e = 0; e < topology.element_count(); ++e) {
    Zone& zone = zones_[at(e)];
    if (zone.travelled == travelled_) continue;
    shape.follow_point(zone);
    const auto& [slots, count] = topology.corners(e);
    const bool held =
        std::all_of(slots.begin(), slots.begin() + count, [&](Index i) { return planes_hold(zone, paths.to[at(i)]); });
    const bool stale = zone.triangle != kNone && travelled_ - zone.travelled > kFreshPart * demand.gap;
    if (stale || !held) marked_[at(e)] = 1;
  }
}

bool PatchZones::planes_hold(const Zone& zone, const Vector3& p) const {
  return is_feasible({zone.planes.data(), at(zone.plane_count)}, p, travelled_ - zone.travelled);
}

void PatchZones::renew(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths, const ZoneDemand& demand,
                       std::span<const Index> slots) {
  travelled_ = shape.travelled();
  for (const Index slot : slots) {
    for (const Index e : topology.elements_of(slot)) marked_[at(e)] = 1;
  }
  make_marked(shape, topology, paths, demand);
}

// A zone that was never made has an empty box, which all its corners are about to leave.
void PatchZones::mark(const PatchTopology& topology, const PatchPaths& paths, const ZoneDemand& demand) {
  const double fresh = kFreshPart * demand.gap;
  for (Index i = 0; i < topology.slot_count(); ++i) {
    Slot& slot = slots_[at(i)];
    const Vector3& to = paths.to[at(i)];
    const bool leaves = !present_box(slot).contains(to);
    const bool stale = slot.near && (to - slot.settled).squaredNorm() > fresh * fresh;
    if (stale) slot.settled = to;
    if (!leaves && !stale && !slot.broken) continue;
    for (const Index e : topology.elements_of(i)) {
      const Zone& zone = zones_[at(e)];
      const bool near = zone.distance < demand.gap + demand.margin;
      if (leaves || (stale && near) || zone.broken) marked_[at(e)] = 1;
    }
  }
}

void PatchZones::make_marked(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths,
                             const ZoneDemand& demand) {
  if (std::find(marked_.begin(), marked_.end(), 1) == marked_.end()) return;
  const double least_reach = std::max(kReachOfSize * demand.size, kReachOfGap * demand.gap);
  ZoneRequest request{
      .gap = demand.gap, .clearance = demand.clearance, .exact = demand.gap + demand.margin, .at_end = demand.at_end};
  for (Index e = 0; e < topology.element_count(); ++e) {
    if (marked_[at(e)] == 0) continue;
    const PatchTopology::Corners& corners = topology.corners(e);
    ElementCorners element{.count = corners.count};
    double motion = 0.0;
    for (std::size_t k = 0; k < at(corners.count); ++k) {
      const std::size_t slot = at(corners.slots[k]);
      element.x[k] = paths.from[slot];
      const double moved = (paths.to[slot] - paths.from[slot]).norm();
      motion = moved <= motion ? motion : moved;  // what is not finite stays
    }
    request.reach = least_reach + kReachOfMotion * motion;
    if (std::isfinite(motion)) {
      shape.find_zone(element, request, zones_[at(e)]);
    } else {
      zones_[at(e)] = Zone{.broken = true};
    }
    for (std::size_t k = 0; k < at(corners.count); ++k) made_around_[at(e)][k] = element.x[k] + zones_[at(e)].drift;
  }
  for (Index i = 0; i < topology.slot_count(); ++i) {
    const auto elements = topology.elements_of(i);
    if (std::any_of(elements.begin(), elements.end(), [&](Index e) { return marked_[at(e)] != 0; })) gather(topology, demand, i);
  }
  std::fill(marked_.begin(), marked_.end(), 0);
  near_elements_.clear();
  for (Index e = 0; e < topology.element_count(); ++e) {
    if (zones_[at(e)].distance < demand.gap + demand.margin) near_elements_.push_back(e);
  }
}

void PatchZones::gather(const PatchTopology& topology, const ZoneDemand& demand, Index i) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Slot& slot = slots_[at(i)];
  const bool was_near = slot.near;
  slot.box = Box3(Vector3::Constant(-kInfinity), Vector3::Constant(kInfinity));
  slot.travelled = travelled_;
  slot.near = slot.broken = false;
  slot.planes.clear();
  slot.quiet = 0.0;
  for (const Index e : topology.elements_of(i)) {
    const Zone& zone = zones_[at(e)];
    slot.broken = slot.broken || zone.broken;
    slot.near = slot.near || zone.distance < demand.gap + demand.margin;
    if (zone.broken) continue;
    const double nearer = travelled_ - zone.travelled;
    slot.box = slot.box.intersection(shrunk(zone.box, nearer));
    for (std::size_t k = 0; k < at(zone.plane_count); ++k) {
      slot.planes.push_back({zone.planes[k].normal, zone.planes[k].offset + nearer});
    }
    const auto& slots = topology.corners(e).slots;
    const auto corner = static_cast<std::size_t>(std::find(slots.begin(), slots.end(), i) - slots.begin());
    const Vector3& made_at = made_around_[at(e)][corner];
    if (zone.clear - nearer > slot.quiet) {
      slot.quiet = zone.clear - nearer;
      slot.centre = made_at;
    }
    if (zone.free_radius == kInfinity) continue;
    // The cube within the ball.
    const Vector3 radius = Vector3::Constant((zone.free_radius - nearer) / std::sqrt(3.0));
    slot.box = slot.box.intersection(Box3(made_at - radius, made_at + radius));
  }
  if (slot.near && !was_near) slot.settled = slot.box.center();
}

bool PatchZones::allow(Index i, const Vector3& p) const {
  const Slot& slot = slots_[at(i)];
  return present_box(slot).contains(p) && is_feasible(slot.planes, p, travelled_ - slot.travelled);
}

void PatchZones::append_half_spaces(Index i, const RigidTransform& pose, std::vector<HalfSpace>& half_spaces) const {
  const auto append = [&](const Vector3& normal, double offset) {
    const Vector3 turned = pose.linear() * normal;
    half_spaces.push_back({turned, offset + turned.dot(pose.translation())});
  };
  const Box3 box = present_box(slots_[at(i)]);
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(box.min()[axis])) continue;
    append(Vector3::Unit(axis), box.min()[axis]);
    append(-Vector3::Unit(axis), -box.max()[axis]);
  }
  const double nearer = travelled_ - slots_[at(i)].travelled;
  for (const HalfSpace& plane : slots_[at(i)].planes) append(plane.normal, plane.offset + nearer);
}

}  // namespace sprung
