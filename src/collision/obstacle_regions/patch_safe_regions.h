// The safe regions of one patch's elements before one obstacle, in the obstacle's frame, cached from step to step.
#pragma once

#include "base/files/binary_archive.h"
#include "collision/core/sphere_set.h"
#include "collision/obstacle_regions/patch_paths.h"
#include "collision/safe_regions/safe_region.h"
#include "collision/shapes/obstacle_shape.h"

#include <array>
#include <vector>

namespace sprung {

/// Records, for each element of a patch, where it was when its closest points were searched last. All positions [m] are in the
/// obstacle's frame.
class ClosestPointTracker {
 public:
  enum class Search : char {
    none,           ///< the known points are still good
    same_triangle,  ///< search on the obstacle's triangle that is known
    whole_surface   ///< search on all of the obstacle
  };

  explicit ClosestPointTracker(std::size_t element_count) : records_(element_count) {}

  /// The whole surface was searched with the element's corners here.
  void reset(Index element, const std::array<Vector3, 3>& corners) {
    records_[static_cast<std::size_t>(element)] = {.corners = corners};
  }

  /// The search that the element needs: none until it has moved by a small fraction of `gap` [m], the whole surface once its
  /// displacements since the last such search add up to `gap`. `drift` [m] is the displacement of the surface at the closest point
  /// in this interval. `is_round` as of ObstacleShape. The caller makes the search that is returned, then calls set_corners().
  [[nodiscard]] Search next_search(Index element, const ElementCorners& corners, const Vector3& drift, double gap, bool is_round);

  /// Records where the element was in the search that next_search() requested.
  void set_corners(Index element, const std::array<Vector3, 3>& corners) {
    records_[static_cast<std::size_t>(element)].corners = corners;
  }

  /// Moves the record with a deforming surface [m].
  void shift(Index element, const Vector3& drift);

 private:
  struct Record {
    std::array<Vector3, 3> corners;  ///< at the last search
    double travelled = 0.0;          ///< sum of displacements since the last search on the whole surface [m]
  };

  template <Same<Record> S, class Visit>
  friend void visit_members(S& r, const Visit& visit) {
    visit(r.corners, r.travelled);
  }
  template <Same<ClosestPointTracker> S, class Visit>
  friend void visit_members(S& t, const Visit& visit) {
    visit(fixed_size(t.records_));
  }

  std::vector<Record> records_;  ///< by element
};

/// Requirements of a patch's regions. All lengths [m].
struct RegionDemand {
  double size = 0.0;       ///< of the elements
  double gap = 0.0;        ///< that contact keeps, at least the clearance
  double margin = 0.0;     ///< contacts are found this much beyond the gap
  double clearance = 0.0;  ///< see SafeRegionRequest
  bool at_end = false;     ///< see SafeRegionRequest
};

class PatchSafeRegions {
 public:
  /// Has no regions yet: update() makes them.
  PatchSafeRegions(Index obstacle, const PatchTopology& topology);

  [[nodiscard]] Index obstacle() const { return obstacle_; }
  [[nodiscard]] const SafeRegion& region(Index element) const { return regions_[static_cast<std::size_t>(element)]; }

  /// Finds the slots whose particle may leave a region on its path to `to`. Most particles do not: each has a sphere around it
  /// inside of its regions. Returns whether there are any.
  bool find_leaving(const ObstacleShape& shape, const SphereVertices& to);

  /// The slots that find_leaving() found last, ascending.
  [[nodiscard]] const std::vector<Index>& leaving() const { return leaving_; }

  /// Makes new regions around `from` for elements that have none and for elements with a corner that leaves its region. First moves
  /// the regions with a deforming surface. Then calls find_leaving(): new regions may not contain other corners' targets.
  void update(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths, const RegionDemand& demand);

  /// Makes new regions around `from` for all elements at these slots.
  void renew(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths, const RegionDemand& demand,
             std::span<const Index> slots);

  /// Whether the regions of all elements at the slot contain p.
  [[nodiscard]] bool allow(Index slot, const Vector3& p) const;
  /// Whether the planes of these regions contain p, whatever the boxes are.
  [[nodiscard]] bool planes_allow(Index slot, const Vector3& p) const;

  /// Replaces `slots` by those, ascending, whose particle may be within `reach` [m] of the surface.
  void find_close(const SphereVertices& particles, double reach, std::vector<Index>& slots) const {
    empty_spheres_.find_outside(particles, reach, slots);
  }

  /// Whether an element at the slot may touch the obstacle.
  [[nodiscard]] bool may_touch(Index slot) const { return slots_[static_cast<std::size_t>(slot)].near; }

  /// Whether the obstacle crosses an element at the slot, which then has no region.
  [[nodiscard]] bool is_crossed(Index slot) const { return slots_[static_cast<std::size_t>(slot)].broken; }

  /// Whether the obstacle crosses any element.
  [[nodiscard]] bool any_crossed() const { return any_crossed_; }

  /// Appends the half-spaces that the particle at the slot has to stay in, transformed to world coordinates by `pose`.
  void append_half_spaces(Index slot, const RigidTransform& pose, std::vector<HalfSpace>& half_spaces) const;

  /// Elements that may touch the obstacle, ascending.
  [[nodiscard]] const std::vector<Index>& near_elements() const { return near_elements_; }

  /// Searches the element's closest points again if it moved (see ClosestPointTracker), at the start of the paths. Returns its
  /// region. Requires update() for the same paths.
  const SafeRegion& renew_closest_points(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths,
                                         const RegionDemand& demand, Index element);

  /// Result of the last search for the surface point closest to the particle.
  [[nodiscard]] SurfaceMemory& memory(Index slot) { return memories_[static_cast<std::size_t>(slot)]; }

 private:
  struct Slot {
    Box3 box;                         ///< intersection of its elements' boxes
    std::vector<HalfSpace> planes{};  ///< of all its elements' regions
    bool near = false;                ///< whether one of its elements may touch
    bool broken = false;              ///< whether one of its elements is crossed
  };

  template <Same<Slot> S, class Visit>
  friend void visit_members(S& s, const Visit& visit) {
    visit(s.box, s.planes, s.near, s.broken);
  }
  /// What stays from step to step.
  template <Same<PatchSafeRegions> S, class Visit>
  friend void visit_members(S& r, const Visit& visit) {
    visit(fixed_size(r.regions_), fixed_size(r.made_around_), r.closest_points_, fixed_size(r.slots_), fixed_size(r.memories_),
          r.inner_spheres_, r.empty_spheres_, r.near_elements_, r.any_crossed_);
  }

  void move_with_surface(const ObstacleShape& shape, const PatchTopology& topology, const RegionDemand& demand);
  void mark_leaving(const PatchTopology& topology, const PatchPaths& paths);
  void make_marked(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths, const RegionDemand& demand);
  void gather_slot(const PatchTopology& topology, const RegionDemand& demand, Index slot);
  /// The box in which the element's corner at this slot may be, by the region's box and radius.
  [[nodiscard]] Box3 corner_box(const PatchTopology& topology, Index element, Index slot) const;
  [[nodiscard]] bool corner_box_contains(const PatchTopology& topology, Index element, Index slot, const Vector3& p) const;
  void set_inner_sphere(Index slot, const Vector3& center);
  void find_near_elements(const PatchTopology& topology, const RegionDemand& demand);

  Index obstacle_;
  std::vector<SafeRegion> regions_;                  ///< by element
  std::vector<std::array<Vector3, 3>> made_around_;  ///< by element: its corners when the region was made
  ClosestPointTracker closest_points_;
  std::vector<Slot> slots_;
  std::vector<SurfaceMemory> memories_;  ///< by slot
  SphereSet inner_spheres_;              ///< by slot: a particle inside leaves no region
  SphereSet empty_spheres_;              ///< by slot: contain nothing of the surface
  std::vector<Index> leaving_;           ///< slots
  std::vector<Index> near_elements_;
  bool any_crossed_ = false;
  std::vector<char> marked_;   ///< by element: 1 where a new region is due; 0 between calls
  std::vector<char> changed_;  ///< by slot: 1 where an element's region is new; 0 between calls
};

}  // namespace sprung
