#include "collision/obstacle_regions/patch_safe_regions.h"

#include "base/grouped_entries.h"
#include "collision/core/half_space.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sprung {
namespace {

// An element that slides farther than this fraction of the gap may be closest to another triangle.
constexpr double kWholeSurface = 1.0;

// A contact plane is reused until the element has moved by this fraction of the gap. With an older plane the element would slide
// straight on over a curved surface, and press into it or leave it.
constexpr double kSameTriangle = 0.02;

// On a round surface the new closest point is nearer than the old one by the square of that motion. The leap keeps a rope that
// rests under load vibrating, so that it creeps: with 0.02 by 25 mm/s on a drum, with this by 0.01 mm/s.
constexpr double kSameTriangleOfRound = 0.0001;

// A region's box is larger than its element on each side by this fraction of the element's size, or of the gap. Larger boxes
// intersect more triangles, smaller ones are left sooner.
constexpr double kReachOfSize = 0.25;
constexpr double kReachOfGap = 0.8;

// The box also contains the corners' targets and is larger by this fraction of their displacement, since constraints change the
// targets later.
constexpr double kReachOfMotion = 0.5;

// A region that lost this fraction of the gap as it moved with a deforming surface is replaced: it may block its element, and its
// closest points may be other ones.
constexpr double kMaxLoss = 0.3;

// An inner sphere has this fraction of the largest possible radius, so that despite rounding it does not exceed a region.
constexpr double kInnerSphereScale = 1.0 - 0x1p-20;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// The paths of an element's corners.
struct ElementPath {
  ElementPath(const PatchPaths& paths, const PatchTopology::Corners& corners) {
    from.count = corners.count;
    for (std::size_t k = 0; k < at(corners.count); ++k) {
      const Vector3 end = paths.to(corners.slots[k]);
      from.x[k] = paths.from(corners.slots[k]);
      to.extend(end);
      const double moved = (end - from.x[k]).norm();
      longest = moved <= longest ? longest : moved;  // a value that is not finite stays
    }
  }

  ElementCorners from{};
  Box3 to{};             ///< around the targets
  double longest = 0.0;  ///< largest displacement [m]; not finite if a corner is not
};

SafeRegionRequest request(const RegionDemand& demand, const ElementPath& path) {
  const double min_reach = std::max(kReachOfSize * demand.size, kReachOfGap * demand.gap);
  return {.reach = min_reach + kReachOfMotion * path.longest,
          .path = path.to,
          .gap = demand.gap,
          .clearance = demand.clearance,
          .exact = demand.gap + demand.margin,
          .at_end = demand.at_end};
}

}  // namespace

PatchTopology::PatchTopology(const CollisionSurface& surface, const ElementPatch& patch) {
  for (Index e = patch.first_element; e < patch.first_element + patch.element_count; ++e) {
    const Element& element = surface.elements[at(e)];
    Corners corners{.count = element.corners};
    for (std::size_t k = 0; k < at(element.corners); ++k) {
      const auto position = std::lower_bound(patch.particles.begin(), patch.particles.end(), element.particles[k]);
      corners.slots[k] = static_cast<Index>(position - patch.particles.begin());
    }
    corners_.push_back(corners);
  }
  const auto visit_all = [&](const auto& add) {
    for (Index e = 0; e < element_count(); ++e) {
      for (std::size_t k = 0; k < at(corners(e).count); ++k) add(corners(e).slots[k], e);
    }
  };
  group_entries(patch.particles.size(), visit_all, first_, elements_);
}

ClosestPointTracker::Search ClosestPointTracker::next_search(Index element, const ElementCorners& corners, const Vector3& drift,
                                                             double gap, bool is_round) {
  Record& record = records_[static_cast<std::size_t>(element)];
  double moved = 0.0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(corners.count); ++k) {
    moved = std::max(moved, (corners.x[k] + drift - record.corners[k]).squaredNorm());
  }
  moved = std::sqrt(moved);
  if (!(moved > (is_round ? kSameTriangleOfRound : kSameTriangle) * gap)) return Search::none;
  const bool same_triangle = record.travelled + moved <= kWholeSurface * gap;
  record.travelled = same_triangle ? record.travelled + moved : 0.0;
  return same_triangle ? Search::same_triangle : Search::whole_surface;
}

void ClosestPointTracker::shift(Index element, const Vector3& drift) {
  for (Vector3& corner : records_[static_cast<std::size_t>(element)].corners) corner += drift;
}

PatchSafeRegions::PatchSafeRegions(Index obstacle, const PatchTopology& topology)
    : obstacle_(obstacle),
      regions_(at(topology.element_count())),
      made_around_(regions_.size()),
      closest_points_(regions_.size()),
      slots_(at(topology.slot_count())),
      memories_(slots_.size()),
      inner_spheres_(slots_.size()),
      empty_spheres_(slots_.size()),
      marked_(regions_.size(), 0),
      changed_(slots_.size(), 0) {}

bool PatchSafeRegions::find_leaving(const ObstacleShape& shape, const SphereVertices& to) {
  if (shape.deforms()) {
    leaving_.resize(slots_.size());
    std::iota(leaving_.begin(), leaving_.end(), Index{0});
  } else {
    inner_spheres_.find_outside(to, 0.0, leaving_);
  }
  return !leaving_.empty();
}

void PatchSafeRegions::update(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths,
                              const RegionDemand& demand) {
  if (shape.deforms()) move_with_surface(shape, topology, demand);
  mark_leaving(topology, paths);
  make_marked(shape, topology, paths, demand);
  find_leaving(shape, paths.to());
}

void PatchSafeRegions::move_with_surface(const ObstacleShape& shape, const PatchTopology& topology, const RegionDemand& demand) {
  bool any_moved = false;
  for (Index e = 0; e < topology.element_count(); ++e) {
    SafeRegion& region = regions_[at(e)];
    const double time = region.time;
    if (!shape.advance_region(region) || (region.triangle != kNone && region.loss > kMaxLoss * demand.gap)) marked_[at(e)] = 1;
    if (region.time == time || std::isnan(region.time)) continue;
    any_moved = true;
    for (Vector3& corner : made_around_[at(e)]) corner += region.drift;
    closest_points_.shift(e, region.drift);
  }
  if (!any_moved) return;
  for (Index i = 0; i < topology.slot_count(); ++i) gather_slot(topology, demand, i);
  find_near_elements(topology, demand);
}

void PatchSafeRegions::renew(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths,
                             const RegionDemand& demand, std::span<const Index> slots) {
  for (const Index slot : slots) {
    for (const Index e : topology.elements_of(slot)) marked_[at(e)] = 1;
  }
  make_marked(shape, topology, paths, demand);
}

// An element without a region has an empty box, so that all its corners leave it.
void PatchSafeRegions::mark_leaving(const PatchTopology& topology, const PatchPaths& paths) {
  for (const Index i : leaving_) {
    const Slot& slot = slots_[at(i)];
    const Vector3 to = paths.to(i);
    set_inner_sphere(i, to);
    if (slot.box.contains(to) && !slot.broken) continue;
    for (const Index e : topology.elements_of(i)) {
      if (regions_[at(e)].broken || !corner_box_contains(topology, e, i, to)) marked_[at(e)] = 1;
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
    const ElementPath path(paths, corners);
    SafeRegion& region = regions_[at(e)];
    if (std::isfinite(path.longest)) {
      shape.find_region(path.from, request(demand, path), region);
    } else {
      region = SafeRegion{.broken = true};
    }
    made_around_[at(e)] = path.from.x;
    for (Vector3& corner : made_around_[at(e)]) corner += region.drift;
    closest_points_.reset(e, made_around_[at(e)]);
    for (std::size_t k = 0; k < at(corners.count); ++k) changed_[at(corners.slots[k])] = 1;
  }
  for (Index i = 0; i < topology.slot_count(); ++i) {
    if (changed_[at(i)] == 0) continue;
    changed_[at(i)] = 0;
    gather_slot(topology, demand, i);
    const Vector3 to = paths.to(i);
    set_inner_sphere(i, slots_[at(i)].box.contains(to) ? to : paths.from(i));
  }
  find_near_elements(topology, demand);
}

const SafeRegion& PatchSafeRegions::renew_closest_points(const ObstacleShape& shape, const PatchTopology& topology,
                                                         const PatchPaths& paths, const RegionDemand& demand, Index e) {
  SafeRegion& region = regions_[at(e)];
  const PatchTopology::Corners& corners = topology.corners(e);
  ElementCorners from{.count = corners.count};
  for (std::size_t k = 0; k < at(corners.count); ++k) from.x[k] = paths.from(corners.slots[k]);
  const auto search = closest_points_.next_search(e, from, region.drift, demand.gap, shape.is_round());
  if (search == ClosestPointTracker::Search::none) return region;
  SafeRegionRequest asked = request(demand, ElementPath(paths, corners));
  asked.reach = std::max(asked.reach, asked.exact);
  shape.update_closest_points(from, asked, search == ClosestPointTracker::Search::same_triangle, region);
  for (Vector3& corner : from.x) corner += region.drift;
  closest_points_.set_corners(e, from.x);
  return region;
}

void PatchSafeRegions::find_near_elements(const PatchTopology& topology, const RegionDemand& demand) {
  near_elements_.clear();
  any_crossed_ = false;
  for (Index e = 0; e < topology.element_count(); ++e) {
    const SafeRegion& region = regions_[at(e)];
    any_crossed_ = any_crossed_ || region.broken;
    if (region.distance < demand.gap + demand.margin) near_elements_.push_back(e);
  }
}

void PatchSafeRegions::gather_slot(const PatchTopology& topology, const RegionDemand& demand, Index i) {
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
  empty_spheres_.set(i, clear_around, clear);
}

// The region's radius is that of a sphere around the corner. The box is the cube inside the sphere.
Box3 PatchSafeRegions::corner_box(const PatchTopology& topology, Index e, Index slot) const {
  const SafeRegion& region = regions_[at(e)];
  if (!std::isfinite(region.free_radius)) return region.box;
  const Vector3& made_at = made_around_[at(e)][topology.corner(e, slot)];
  const Vector3 radius = Vector3::Constant(region.free_radius / std::sqrt(3.0));
  return region.box.intersection(Box3(made_at - radius, made_at + radius));
}

bool PatchSafeRegions::corner_box_contains(const PatchTopology& topology, Index e, Index slot, const Vector3& p) const {
  const SafeRegion& region = regions_[at(e)];
  if (!region.box.contains(p)) return false;
  return !std::isfinite(region.free_radius) || corner_box(topology, e, slot).contains(p);
}

void PatchSafeRegions::set_inner_sphere(Index i, const Vector3& center) {
  const Slot& slot = slots_[at(i)];
  double radius = slot.broken ? 0.0 : std::min((center - slot.box.min()).minCoeff(), (slot.box.max() - center).minCoeff());
  for (const HalfSpace& plane : slot.planes) radius = std::min(radius, plane.normal.dot(center) - plane.offset);
  inner_spheres_.set(i, center, kInnerSphereScale * radius);
}

bool PatchSafeRegions::allow(Index i, const Vector3& p) const { return slots_[at(i)].box.contains(p) && planes_allow(i, p); }

bool PatchSafeRegions::planes_allow(Index i, const Vector3& p) const { return is_feasible(slots_[at(i)].planes, p); }

void PatchSafeRegions::append_half_spaces(Index i, const RigidTransform& pose, std::vector<HalfSpace>& half_spaces) const {
  const auto append = [&](const Vector3& normal, double offset) {
    const Vector3 rotated = pose.linear() * normal;
    half_spaces.push_back({rotated, offset + rotated.dot(pose.translation())});
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
