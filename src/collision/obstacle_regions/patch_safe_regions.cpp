#include "collision/obstacle_regions/patch_safe_regions.h"

#include "collision/core/feasible_point.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sprung {

namespace {

// A region's box is this part of an element's size, or of the gap, larger than the element on each side: larger ones meet more
// triangles, smaller ones are left sooner.
constexpr double kReachOfSize = 0.25;
constexpr double kReachOfGap = 0.8;

// It holds the corners' way too, and is larger by this part of it, since constraints lead them elsewhere.
constexpr double kReachOfMotion = 0.5;

// Nearest points are looked for again after a way of this part of the gap: what slides goes over others.
constexpr double kFreshPart = 1.0;

// And after one of this part on the same triangle: the plane there lets the element go on straight where the surface is round, and
// what slid down an ear stuck to it.
constexpr double kSeenPart = 0.02;

// Zones that a surface that deforms takes along are made again when they lost this part of the gap.
constexpr double kMostLoss = 0.3;

// Calm balls are this part of what they could be, which is more than rounding.
constexpr double kCalmPart = 1.0 - 0x1p-20;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// The ways of an element's corners.
struct ElementWay {
  ElementWay(const PatchPaths& paths, const PatchTopology::Corners& corners) {
    from.count = corners.count;
    for (std::size_t k = 0; k < at(corners.count); ++k) {
      const Vector3 end = paths.to(corners.slots[k]);
      from.x[k] = paths.from(corners.slots[k]);
      to.extend(end);
      const double moved = (end - from.x[k]).norm();
      longest = moved <= longest ? longest : moved;  // what is not finite stays
    }
  }

  ElementCorners from{};
  Box3 to{};             ///< around where the corners go
  double longest = 0.0;  ///< [m]; not finite where a corner is not
};

SafeRegionRequest request(const RegionDemand& demand, bool pinned, const ElementWay& way) {
  const double least_reach = std::max(kReachOfSize * demand.size, kReachOfGap * demand.gap);
  return {.reach = least_reach + kReachOfMotion * way.longest,
          .way = way.to,
          .gap = demand.gap,
          .clearance = demand.clearance,
          .exact = demand.gap + demand.margin + (demand.ahead && pinned ? way.longest : 0.0),
          .at_end = demand.at_end};
}

}  // namespace

PatchSafeRegions::PatchSafeRegions(Index obstacle, const PatchTopology& topology)
    : obstacle_(obstacle),
      regions_(at(topology.element_count())),
      made_around_(regions_.size()),
      sights_(regions_.size()),
      slots_(at(topology.slot_count())),
      memories_(slots_.size()),
      calm_(slots_.size()),
      quiet_(slots_.size()),
      marked_(regions_.size(), 0),
      changed_(slots_.size(), 0) {}

bool PatchSafeRegions::find_restless(const ObstacleShape& shape, const SphereVertices& to) {
  if (shape.deforms()) {
    restless_.resize(slots_.size());
    std::iota(restless_.begin(), restless_.end(), Index{0});
  } else {
    calm_.find_outside(to, 0.0, restless_);
  }
  return !restless_.empty();
}

void PatchSafeRegions::follow(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths,
                              const RegionDemand& demand) {
  if (shape.deforms()) take_along(shape, topology, demand);
  mark(topology, paths);
  make_marked(shape, topology, paths, demand);
  find_restless(shape, paths.to());
}

// Zones that lost much on the way may stand in the way of their elements, or not be the nearest points' any more.
void PatchSafeRegions::take_along(const ObstacleShape& shape, const PatchTopology& topology, const RegionDemand& demand) {
  bool along = false;
  for (Index e = 0; e < topology.element_count(); ++e) {
    SafeRegion& region = regions_[at(e)];
    const double time = region.time;
    if (!shape.take_along(region) || (region.triangle != kNone && region.loss > kMostLoss * demand.gap)) marked_[at(e)] = 1;
    if (region.time == time || std::isnan(region.time)) continue;
    along = true;
    for (Vector3& corner : made_around_[at(e)]) corner += region.drift;
    for (Vector3& corner : sights_[at(e)].from) corner += region.drift;
  }
  if (!along) return;
  for (Index i = 0; i < topology.slot_count(); ++i) gather(topology, demand, i);
  find_near_elements(topology, demand);
}

void PatchSafeRegions::renew(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths,
                             const RegionDemand& demand, std::span<const Index> slots) {
  for (const Index slot : slots) {
    for (const Index e : topology.elements_of(slot)) marked_[at(e)] = 1;
  }
  make_marked(shape, topology, paths, demand);
}

// A region that was never made has an empty box, which all its corners are about to leave.
void PatchSafeRegions::mark(const PatchTopology& topology, const PatchPaths& paths) {
  for (const Index i : restless_) {
    const Slot& slot = slots_[at(i)];
    const Vector3 to = paths.to(i);
    calm_down(i, to);
    if (slot.box.contains(to) && !slot.broken) continue;
    for (const Index e : topology.elements_of(i)) {
      if (regions_[at(e)].broken || !boxes(topology, e, i, to)) marked_[at(e)] = 1;
    }
  }
}

void PatchSafeRegions::make_marked(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths,
                                   const RegionDemand& demand) {
  if (std::find(marked_.begin(), marked_.end(), 1) == marked_.end()) return;
  for (Index e = 0; e < topology.element_count(); ++e) {
    if (marked_[at(e)] == 0) continue;
    marked_[at(e)] = 0;
    const PatchTopology::Corners& corners = topology.corners(e);
    const ElementWay way(paths, corners);
    SafeRegion& region = regions_[at(e)];
    if (std::isfinite(way.longest)) {
      shape.find_region(way.from, request(demand, corners.pinned, way), region);
    } else {
      region = SafeRegion{.broken = true};
    }
    made_around_[at(e)] = way.from.x;
    for (Vector3& corner : made_around_[at(e)]) corner += region.drift;
    sights_[at(e)] = {made_around_[at(e)]};
    for (std::size_t k = 0; k < at(corners.count); ++k) changed_[at(corners.slots[k])] = 1;
  }
  for (Index i = 0; i < topology.slot_count(); ++i) {
    if (changed_[at(i)] == 0) continue;
    changed_[at(i)] = 0;
    gather(topology, demand, i);
    const Vector3 to = paths.to(i);
    calm_down(i, slots_[at(i)].box.contains(to) ? to : paths.from(i));
  }
  find_near_elements(topology, demand);
}

const SafeRegion& PatchSafeRegions::look_again(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths,
                                               const RegionDemand& demand, Index e) {
  SafeRegion& region = regions_[at(e)];
  Sight& sight = sights_[at(e)];
  const PatchTopology::Corners& corners = topology.corners(e);
  double moved = 0.0;
  for (std::size_t k = 0; k < at(corners.count); ++k) {
    moved = std::max(moved, (paths.from(corners.slots[k]) + region.drift - sight.from[k]).squaredNorm());
  }
  moved = std::sqrt(moved);
  if (!(moved > kSeenPart * demand.gap)) return region;
  const ElementWay way(paths, corners);
  SafeRegionRequest asked = request(demand, corners.pinned, way);
  asked.reach = std::max(asked.reach, asked.exact);
  const bool fresh = sight.way + moved <= kFreshPart * demand.gap;
  shape.look_again(way.from, asked, fresh, region);
  sight = {way.from.x, fresh ? sight.way + moved : 0.0};
  for (Vector3& corner : sight.from) corner += region.drift;
  return region;
}

void PatchSafeRegions::find_near_elements(const PatchTopology& topology, const RegionDemand& demand) {
  near_elements_.clear();
  crosses_ = false;
  for (Index e = 0; e < topology.element_count(); ++e) {
    const SafeRegion& region = regions_[at(e)];
    crosses_ = crosses_ || region.broken;
    const bool comes_near = demand.ahead && topology.corners(e).pinned && std::isfinite(region.distance);
    if (region.distance < demand.gap + demand.margin || comes_near) near_elements_.push_back(e);
  }
}

void PatchSafeRegions::gather(const PatchTopology& topology, const RegionDemand& demand, Index i) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Slot& slot = slots_[at(i)];
  slot.box = Box3(Vector3::Constant(-kInfinity), Vector3::Constant(kInfinity));
  slot.near = slot.broken = false;
  slot.planes.clear();
  double clear = 0.0;
  Vector3 clear_around = Vector3::Zero();
  for (const Index e : topology.elements_of(i)) {
    const SafeRegion& region = regions_[at(e)];
    slot.broken = slot.broken || region.broken;
    slot.near = slot.near || region.distance < demand.gap + demand.margin;
    if (region.broken) continue;
    slot.box = slot.box.intersection(corner_box(topology, e, i));
    slot.planes.insert(slot.planes.end(), region.planes.begin(), region.planes.begin() + region.plane_count);
    if (!(region.clear > clear)) continue;
    clear = region.clear;
    clear_around = made_around_[at(e)][topology.corner(e, i)];
  }
  quiet_.set(i, clear_around, clear);
}

// The radius is that of a ball: the cube within it.
Box3 PatchSafeRegions::corner_box(const PatchTopology& topology, Index e, Index slot) const {
  const SafeRegion& region = regions_[at(e)];
  if (!std::isfinite(region.free_radius)) return region.box;
  const Vector3& made_at = made_around_[at(e)][topology.corner(e, slot)];
  const Vector3 radius = Vector3::Constant(region.free_radius / std::sqrt(3.0));
  return region.box.intersection(Box3(made_at - radius, made_at + radius));
}

bool PatchSafeRegions::boxes(const PatchTopology& topology, Index e, Index slot, const Vector3& p) const {
  const SafeRegion& region = regions_[at(e)];
  if (!region.box.contains(p)) return false;
  return !std::isfinite(region.free_radius) || corner_box(topology, e, slot).contains(p);
}

void PatchSafeRegions::calm_down(Index i, const Vector3& p) {
  const Slot& slot = slots_[at(i)];
  double radius = slot.broken ? 0.0 : std::min((p - slot.box.min()).minCoeff(), (slot.box.max() - p).minCoeff());
  for (const HalfSpace& plane : slot.planes) radius = std::min(radius, plane.normal.dot(p) - plane.offset);
  calm_.set(i, p, kCalmPart * radius);
}

bool PatchSafeRegions::allow(Index i, const Vector3& p) const { return slots_[at(i)].box.contains(p) && planes_allow(i, p); }

bool PatchSafeRegions::planes_allow(Index i, const Vector3& p) const { return is_feasible(slots_[at(i)].planes, p); }

void PatchSafeRegions::append_half_spaces(Index i, const RigidTransform& pose, std::vector<HalfSpace>& half_spaces) const {
  const auto append = [&](const Vector3& normal, double offset) {
    const Vector3 turned = pose.linear() * normal;
    half_spaces.push_back({turned, offset + turned.dot(pose.translation())});
  };
  const Box3& box = slots_[at(i)].box;
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(box.min()[axis])) continue;
    append(Vector3::Unit(axis), box.min()[axis]);
    append(-Vector3::Unit(axis), -box.max()[axis]);
  }
  for (const HalfSpace& plane : slots_[at(i)].planes) append(plane.normal, plane.offset);
}

}  // namespace sprung
