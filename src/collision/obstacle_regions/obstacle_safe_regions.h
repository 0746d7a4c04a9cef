// The safe regions of all elements before all obstacles.
#pragma once

#include "collision/core/contact.h"
#include "collision/obstacle_regions/blocked_vertex.h"
#include "collision/obstacle_regions/patch_paths.h"
#include "collision/obstacle_regions/patch_safe_regions.h"
#include "collision/obstacle_regions/permitted_crossing.h"
#include "collision/obstacles/obstacle_frame.h"
#include "collision/surface/collision_surface.h"

#include <vector>

namespace sprung {

/// A cache: regions stay valid from step to step while their elements stay inside. ObstacleMotion computes from it how obstacles
/// move particles.
class ObstacleSafeRegions {
 public:
  /// Contacts are found up to `margin` [m] beyond their gap. No spring is stretched at `rest` [m], 3 x n. Keeps a reference to the
  /// surface. Frames in later calls must be those of `set`.
  ObstacleSafeRegions(const ObstacleSet& set, const CollisionSurface& surface, const Points& rest, double margin);

  /// Reads again which particles of the surface are fixed.
  void find_fixed();

  /// Makes regions for elements near obstacles that have none, or leave theirs on these paths.
  void update(const StepPaths& paths);

  /// Makes new regions for all elements around these particles, at the start of the paths.
  void renew_around(const std::vector<Index>& particles, const StepPaths& paths);

  /// Discards all regions and restores the permitted crossings. Call it after the state was rolled back.
  void roll_back(const PermittedCrossings& permitted);

  /// Writes the regions and what was found with them.
  void save(ByteWriter& to) const;
  /// Call it after roll_back(). Throws BytesError if this was not written for the same surface and obstacles.
  void load(BinaryReader& from);

  /// Permits crossings of elements that an obstacle crosses and a pin pulls through it, until they are free again: their corners
  /// have no regions and no contacts with that obstacle. Requires update() for paths that start at `from`.
  void permit_crossings(const Points& from);
  /// The crossings that are permitted now.
  [[nodiscard]] const PermittedCrossings& permitted_crossings() const { return permitted_crossings_; }

  /// The particles that may leave their regions on the paths of the last update() or renew_around(), and the corners of elements
  /// that an obstacle crosses; ascending.
  [[nodiscard]] std::vector<Index> leaving() const;

  /// Appends contacts of particles (see ObstacleFrame::contacts), then contacts of obstacles with the inside of edges and faces, at
  /// the regions' closest points; patch by patch. Patches that hardly move have a smaller margin. Requires update() for the same
  /// paths.
  void find_contacts(const StepPaths& paths, std::vector<Contact>& contacts);
  /// Finds the contacts of the patches of these particles alone.
  [[nodiscard]] FreshContacts find_contacts_around(const std::vector<Index>& particles, const StepPaths& paths);

  // `obstacles` are those of the last update() or renew_around().

  /// Whether the regions of all elements around the particle contain the position at the end of the interval.
  [[nodiscard]] bool allow(const ObstacleFrame& obstacles, Index particle, const Vector3& position) const;
  /// Whether the particle and its neighbours are fixed and did not move in the last update(), and no obstacle ever moves: nothing
  /// is to be tested.
  [[nodiscard]] bool is_at_rest(Index particle) const;
  /// Whether the planes of these regions allow the position, whatever the boxes are. If so, no known obstacle is between the
  /// particle and the position.
  [[nodiscard]] bool planes_allow(const ObstacleFrame& obstacles, Index particle, const Vector3& position) const;
  /// Appends the half-spaces that the particle has to stay in at the end of the interval.
  void append_half_spaces(const ObstacleFrame& obstacles, Index particle, std::vector<HalfSpace>& half_spaces) const;

  /// Whether an obstacle crosses any element.
  [[nodiscard]] bool any_crossed() const;
  /// Whether an obstacle crosses an element around the particle.
  [[nodiscard]] bool is_crossed(Index particle) const;

 private:
  friend class ObstacleMotion;

  struct Patch {
    PatchTopology topology;
    std::vector<PatchSafeRegions> regions{};  ///< of the obstacles near it, ascending by obstacle
    std::vector<char> own{};                  ///< by slot: 1 for particles that no earlier patch contains
    std::vector<Index> leaving{};             ///< particles that may leave a region
    std::vector<Index> close{};               ///< slots of particles that may have contacts
    std::vector<Contact> contacts{};          ///< by find_contacts()
    Box3 box{};                               ///< around its particles' paths
    Box3 known{};                             ///< all obstacles that intersect this box are in `regions`
    double size = 0.0;                        ///< of its elements [m]
    double thickness = 0.0;                   ///< largest of its particles [m]
    bool fixed = false;                       ///< whether all its particles are
    bool is_at_rest = false;                  ///< whether it is fixed and known, and nothing moved in the last update()
  };

  void set_permitted(PermittedCrossings crossings);
  void append_permitted(Index patch, const PatchSafeRegions& regions, const Points& from, PermittedCrossings& permitted) const;
  [[nodiscard]] bool is_overstretched(const Element& element, const Points& positions) const;
  [[nodiscard]] bool is_permitted(Index k, Index particle) const {
    return permitted_[static_cast<std::size_t>(k)][static_cast<std::size_t>(particle)] != 0;
  }
  [[nodiscard]] bool stands_still(Index patch, const StepPaths& paths) const;
  void find_near(Index patch, const StepPaths& paths, double max_displacement);
  void append_leaving(Index patch, const PatchSafeRegions& regions);
  [[nodiscard]] PatchPaths patch_paths(Index patch, Index obstacle, const StepPaths& paths) const;
  [[nodiscard]] RegionDemand demand(const Patch& patch, Index obstacle, const StepPaths& paths) const;
  void find_contacts_of(const std::vector<Index>& patches, const StepPaths& paths, std::vector<Contact>& contacts);
  void append_particle_contacts(Index patch, PatchSafeRegions& regions, const StepPaths& paths, double margin, double reach);
  void append_element_contacts(Index patch, PatchSafeRegions& regions, const StepPaths& paths, const RegionDemand& demand,
                               double margin);
  [[nodiscard]] std::span<const PatchSlot> slots_of(Index particle) const;
  /// The patches of these particles, ascending.
  [[nodiscard]] std::vector<Index> patches_around(const std::vector<Index>& particles) const;
  [[nodiscard]] const std::vector<Index>& particles_of(Index patch) const {
    return surface_.patches[static_cast<std::size_t>(patch)].particles;
  }

  const CollisionSurface& surface_;
  double margin_;
  Points rest_;
  std::vector<Patch> patches_;
  PermittedCrossings permitted_crossings_;
  std::vector<std::vector<char>> permitted_;  ///< by obstacle, by particle: whether it may cross
};

}  // namespace sprung
