// The free space of one patch's elements before one obstacle, in the obstacle's frame, kept from step to step.
#pragma once

#include "collision/core/sphere_set.h"
#include "collision/obstacle_regions/patch_topology.h"
#include "collision/shapes/obstacle_shape.h"

#include <vector>

namespace sprung {

/// Where the patch's particles are and where they are about to be, in the obstacle's frame, by slot. Refers to what it is made of.
class PatchPaths {
 public:
  /// Columns of positions [m], 3 x n, and the ways into the frame.
  PatchPaths(const SphereVertices& from, const SphereVertices& to) : from_(from), to_(to) {}

  [[nodiscard]] Vector3 from(Index slot) const { return position(from_, slot); }
  [[nodiscard]] Vector3 to(Index slot) const { return position(to_, slot); }
  [[nodiscard]] const SphereVertices& to() const { return to_; }

 private:
  [[nodiscard]] static Vector3 position(const SphereVertices& at, Index slot) {
    return at.into * at.positions.col(at.particles[static_cast<std::size_t>(slot)]);
  }

  SphereVertices from_;
  SphereVertices to_;
};

/// What a patch's regions are made for. All lengths [m].
struct RegionDemand {
  double size = 0.0;       ///< of the elements
  double gap = 0.0;        ///< that contact keeps, at least the clearance
  double margin = 0.0;     ///< contacts are found this much beyond the gap
  double clearance = 0.0;  ///< see SafeRegionRequest
  bool at_end = false;
  bool ahead = false;  ///< elements at pins are near whatever comes near them on their way
};

class PatchSafeRegions {
 public:
  PatchSafeRegions(Index obstacle, const PatchTopology& topology);

  [[nodiscard]] Index obstacle() const { return obstacle_; }
  [[nodiscard]] const SafeRegion& region(Index element) const { return regions_[static_cast<std::size_t>(element)]; }

  /// Finds the slots that follow() has to look at when these particles, by slot, go to these places: most stay where nothing
  /// changes for their regions. Returns whether there are any.
  bool find_restless(const ObstacleShape& shape, const SphereVertices& to);
  /// As they were found last, ascending.
  [[nodiscard]] const std::vector<Index>& restless() const { return restless_; }

  /// Makes the regions again, around `from`, of elements that have none, or that a restless corner is about to leave. A surface
  /// that deforms takes the regions along. Finds the restless slots again: what the regions hold is not among them any more, what
  /// new regions do not hold is.
  void follow(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths, const RegionDemand& demand);

  /// Makes the regions of all elements at these slots again, around `from`.
  void renew(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths, const RegionDemand& demand,
             std::span<const Index> slots);

  /// Whether the regions of all elements at the slot hold p.
  [[nodiscard]] bool allow(Index slot, const Vector3& p) const;
  /// The same of their planes alone.
  [[nodiscard]] bool planes_allow(Index slot, const Vector3& p) const;

  /// Replaces `slots` by those, ascending, within `reach` [m] of whose particle there may be something of the surface: most are
  /// where nothing is.
  void find_close(const SphereVertices& particles, double reach, std::vector<Index>& slots) const {
    quiet_.find_outside(particles, reach, slots);
  }

  /// Whether an element at the slot may touch.
  [[nodiscard]] bool may_lean(Index slot) const { return slots_[static_cast<std::size_t>(slot)].near; }

  /// Whether the obstacle crosses an element at the slot, which then has no region.
  [[nodiscard]] bool is_crossed(Index slot) const { return slots_[static_cast<std::size_t>(slot)].broken; }

  /// Whether it crosses any element.
  [[nodiscard]] bool crosses() const { return crosses_; }

  /// Appends all that bounds the slot, placed in the world by `pose`.
  void append_half_spaces(Index slot, const RigidTransform& pose, std::vector<HalfSpace>& half_spaces) const;

  /// Elements that may touch, ascending.
  [[nodiscard]] const std::vector<Index>& near_elements() const { return near_elements_; }

  /// The element's region, with the nearest points that it has where the way begins (see ObstacleShape::look_again). Requires
  /// follow() for the same way.
  const SafeRegion& look_again(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths,
                               const RegionDemand& demand, Index element);

  /// What the last search for the surface near a particle found.
  [[nodiscard]] SurfaceMemory& memory(Index slot) { return memories_[static_cast<std::size_t>(slot)]; }

 private:
  struct Slot {
    Box3 box;                         ///< of all regions at it
    std::vector<HalfSpace> planes{};  ///< of all regions at it
    bool near = false;                ///< an element at it may touch
    bool broken = false;
  };

  struct Sight {
    std::array<Vector3, 3> from;  ///< the element's corners when its nearest points were found last
    double way = 0.0;             ///< that they went since the whole surface was looked at [m]
  };

  void take_along(const ObstacleShape& shape, const PatchTopology& topology, const RegionDemand& demand);
  void mark(const PatchTopology& topology, const PatchPaths& paths);
  void make_marked(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths, const RegionDemand& demand);
  void gather(const PatchTopology& topology, const RegionDemand& demand, Index slot);
  /// Where the region's box and radius let a corner of the element be that is at the slot.
  [[nodiscard]] Box3 corner_box(const PatchTopology& topology, Index element, Index slot) const;
  /// Whether that holds p.
  [[nodiscard]] bool boxes(const PatchTopology& topology, Index element, Index slot, const Vector3& p) const;
  void calm_down(Index slot, const Vector3& p);
  void find_near_elements(const PatchTopology& topology, const RegionDemand& demand);

  Index obstacle_;
  std::vector<SafeRegion> regions_;                  ///< by element
  std::vector<std::array<Vector3, 3>> made_around_;  ///< the corners when the region was made
  std::vector<Sight> sights_;                        ///< by element
  std::vector<Slot> slots_;
  std::vector<SurfaceMemory> memories_;  ///< by slot
  SphereSet calm_;                       ///< by slot: a particle in it leaves no region and needs no new ones
  SphereSet quiet_;                      ///< by slot: holds nothing of the surface
  std::vector<Index> restless_;          ///< slots
  std::vector<Index> near_elements_;
  bool crosses_ = false;
  std::vector<char> marked_;   ///< by element; 0 between calls
  std::vector<char> changed_;  ///< by slot: whether a region at it was made again; 0 between calls
};

}  // namespace sprung
