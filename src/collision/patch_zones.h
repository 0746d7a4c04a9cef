// The free space of one patch's elements before one obstacle, in the obstacle's frame, kept from step to step.
#pragma once

#include "collision/obstacle_shape.h"
#include "collision/patch_topology.h"

#include <vector>

namespace sprung {

/// Where the patch's particles are and where they are about to be, in the obstacle's frame [m], by slot.
struct PatchPaths {
  std::vector<Vector3> from;
  std::vector<Vector3> to;
};

/// What a patch's zones are made for. All lengths [m].
struct ZoneDemand {
  double size = 0.0;       ///< of the elements
  double gap = 0.0;        ///< that contact keeps, at least the clearance
  double margin = 0.0;     ///< contacts are found this much beyond the gap
  double clearance = 0.0;  ///< see ZoneRequest
  bool at_end = false;
};

class PatchZones {
 public:
  PatchZones(Index obstacle, const PatchTopology& topology);

  [[nodiscard]] Index obstacle() const { return obstacle_; }
  [[nodiscard]] const Zone& zone(Index element) const { return zones_[static_cast<std::size_t>(element)]; }

  /// Finds the slots that follow() has to look at when their particles go to these places, in the obstacle's frame: most stay where
  /// nothing changes for their zones. Returns whether there are any.
  bool find_restless(const ObstacleShape& shape, const std::vector<Vector3>& to);
  /// As they were found last, ascending.
  [[nodiscard]] const std::vector<Index>& restless() const { return restless_; }

  /// Makes the zones again, around `from`, of elements that have none, that a restless corner is about to leave, or that moved by a
  /// part of the gap since their nearest points were found. A surface that deforms takes the zones along.
  void follow(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths, const ZoneDemand& demand);

  /// Makes the zones of all elements at these slots again, around `from`.
  void renew(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths, const ZoneDemand& demand,
             std::span<const Index> slots);

  /// Whether the zones of all elements at the slot hold p.
  [[nodiscard]] bool allow(Index slot, const Vector3& p) const;

  /// Whether nothing of the surface can be within `reach` [m] of the slot's particle at p: so of most where nothing is.
  [[nodiscard]] bool is_far(Index slot, const Vector3& p, double reach) const {
    const auto i = static_cast<std::size_t>(slot);
    const Ball searched{memories_[i].asked_at, memories_[i].clear};
    return quiet_[i].holds(p, reach) || searched.holds(p, reach);
  }

  /// Whether an element at the slot may touch.
  [[nodiscard]] bool may_lean(Index slot) const { return slots_[static_cast<std::size_t>(slot)].near; }

  /// Whether the obstacle crosses an element at the slot, which then has no zone.
  [[nodiscard]] bool is_crossed(Index slot) const { return slots_[static_cast<std::size_t>(slot)].broken; }

  /// Whether it crosses any element.
  [[nodiscard]] bool crosses() const { return crosses_; }

  /// Appends all that bounds the slot, placed in the world by `pose`.
  void append_half_spaces(Index slot, const RigidTransform& pose, std::vector<HalfSpace>& half_spaces) const;

  /// Elements that may touch, ascending.
  [[nodiscard]] const std::vector<Index>& near_elements() const { return near_elements_; }

  /// What the last search for the surface near a particle found.
  [[nodiscard]] SurfaceMemory& memory(Index slot) { return memories_[static_cast<std::size_t>(slot)]; }

 private:
  struct Slot {
    Box3 box;                         ///< of all zones at it
    Vector3 settled;                  ///< where it was when its near elements were looked at last
    std::vector<HalfSpace> planes{};  ///< of all zones at it
    bool near = false;                ///< an element at it may touch
    bool broken = false;
  };

  struct Ball {
    Vector3 centre = Vector3::Zero();
    double radius = 0.0;  ///< [m]; at most 0 for one that holds nothing

    /// Whether p is in it, at least `margin` [m] from its surface.
    [[nodiscard]] bool holds(const Vector3& p, double margin = 0.0) const {
      const double free = radius - margin;
      return free > 0.0 && (p - centre).squaredNorm() < free * free;
    }
  };

  void take_along(const ObstacleShape& shape, const PatchTopology& topology, const ZoneDemand& demand);
  void mark(const PatchTopology& topology, const PatchPaths& paths, const ZoneDemand& demand);
  void make_marked(const ObstacleShape& shape, const PatchTopology& topology, const PatchPaths& paths, const ZoneDemand& demand);
  void gather(const PatchTopology& topology, const ZoneDemand& demand, Index slot);
  void calm_down(Index slot, const Vector3& p, const ZoneDemand& demand);
  void find_near_elements(const ZoneDemand& demand);

  Index obstacle_;
  std::vector<Zone> zones_;                          ///< by element
  std::vector<std::array<Vector3, 3>> made_around_;  ///< the corners when the zone was made
  std::vector<Slot> slots_;
  std::vector<SurfaceMemory> memories_;  ///< by slot
  std::vector<Ball> calm_;               ///< by slot: a particle in it leaves no zone and needs no new ones
  std::vector<Ball> quiet_;              ///< by slot: holds nothing of the surface
  std::vector<Index> restless_;          ///< slots
  std::vector<Index> near_elements_;
  bool crosses_ = false;
  std::vector<char> marked_;  ///< by element; 0 between calls
};

}  // namespace sprung
