// The regions of all elements before all obstacles.
#pragma once

#include "collision/core/contact.h"
#include "collision/obstacle_regions/kinematic_anchor.h"
#include "collision/obstacle_regions/moved_vertex.h"
#include "collision/obstacle_regions/patch_safe_regions.h"
#include "collision/obstacle_regions/permitted_crossing.h"
#include "collision/obstacles/obstacle_set.h"
#include "collision/surface/collision_surface.h"

#include <vector>

namespace sprung {

/// Particles on their way [m], 3 x n.
struct Way {
  const Points& from;           ///< where nothing crosses
  const Points& to;             ///< where they are about to be at the end of the obstacles' interval
  bool obstacles_rest = false;  ///< obstacles are at the interval's end already when the way begins
};

class ObstacleSafeRegions {
 public:
  /// Contacts are found up to `margin` [m] beyond their gap. The network is stretched by nothing at `rest` [m], 3 x n. Keeps
  /// references to set and surface.
  ObstacleSafeRegions(const ObstacleSet& set, const CollisionSurface& surface, const Points& rest, double margin);

  /// Makes regions where elements are near obstacles and have none that holds them on their way.
  void follow(const Way& way);

  /// What permit_crossings() let through last.
  [[nodiscard]] const PermittedCrossings& permitted_crossings() const { return permitted_crossings_; }
  /// Drops all regions: the next way does not begin where the last one ended, but where this was let through.
  void roll_back(const PermittedCrossings& permitted);

  /// Whether elements at pins are near whatever comes near them on their way, for regions that are made from now on.
  void look_ahead(bool ahead) { ahead_ = ahead; }

  /// Particles that might not be held by their regions where they are about to be, as follow() and what came after it saw it, or
  /// whose elements an obstacle crosses; ascending.
  [[nodiscard]] std::vector<Index> restless() const;

  /// Lets corners of elements that an obstacle crosses and drags along through it, until they are free of it: for them there are no
  /// regions and no contacts. Requires follow() for a way that begins at `from`.
  void permit_crossings(const Points& from);

  /// Makes the regions of all elements around these particles again, where they are when the way begins.
  void renew_around(const std::vector<Index>& particles, const Way& way);

  /// Appends contacts of particles (see Environment::contacts), then those of obstacles with the inside of elements, at the
  /// regions' nearest points; patch by patch. Where hardly anything moves they are found less than the margin beyond their gap.
  /// Requires follow() for the same way.
  void find_contacts(const Way& way, std::vector<Contact>& contacts);

  /// The same, of the patches of these particles.
  [[nodiscard]] FreshContacts find_contacts_around(const std::vector<Index>& particles, const Way& way);

  /// Whether the regions of all elements around the particle hold it there, at the interval's end.
  [[nodiscard]] bool allow(Index particle, const Vector3& position) const;

  /// The same of the regions' planes alone: whether none is between an obstacle and the position.
  [[nodiscard]] bool planes_allow(Index particle, const Vector3& position) const;

  /// Whether an obstacle crosses any element.
  [[nodiscard]] bool crosses() const;
  /// Whether an obstacle crosses an element around the particle.
  [[nodiscard]] bool is_crossed(Index particle) const;

  /// Appends what bounds the particle at the interval's end.
  void append_half_spaces(Index particle, std::vector<HalfSpace>& half_spaces) const;

  /// Particles that lean on an obstacle that moves, ascending, and how far it carries them from there.
  [[nodiscard]] std::vector<ParticleDisplacement> carried(const Points& from) const;

  /// Where an obstacle that moves near the particle carries it from `from` without leading it through itself or another one;
  /// nothing if none does.
  [[nodiscard]] std::optional<Vector3> carried(Index particle, const Vector3& from) const;

  /// The particle, held by the first obstacle that moves and that does not let it be at `position`, if there is one.
  [[nodiscard]] KinematicAnchor anchor(Index particle, const Vector3& from, const Vector3& position) const;

  /// Where obstacles that move take elements along which they would cross now, each with what was nearest to it at `from`, and
  /// higher by `lift` (see ObstacleShape::carried): the corners' places, ascending by particle, of a corner of several elements
  /// with the nearest of them.
  [[nodiscard]] std::vector<MovedVertex> carried_with_elements(const Points& from, double lift) const;

  /// How far obstacles come towards elements at pins in the interval, seen from the pins: for the elements' other corners, of each
  /// what is nearest to it, ascending by particle. Requires that their regions were made for this way.
  [[nodiscard]] std::vector<Push> pushes_at_pins(const Way& way) const;

  /// Appends where the obstacles that move near the particle carry it from `from`.
  void append_carried(Index particle, const Vector3& from, std::vector<Vector3>& places) const;

 private:
  struct Patch {
    PatchTopology topology;
    std::vector<PatchSafeRegions> regions{};  ///< by obstacle, ascending: those that are near
    std::vector<char> own{};                  ///< by slot: 1 for particles that no patch before it has
    std::vector<Index> restless{};            ///< its particles that may leave a region
    std::vector<Index> close{};               ///< slots of particles that may have contacts, by find_contacts()
    std::vector<Contact> contacts{};          ///< by find_contacts()
    Box3 box{};                               ///< around its particles' ways
    Box3 known{};                             ///< what meets this box is in `regions`
    double size = 0.0;                        ///< of its elements [m]
    double thickness = 0.0;                   ///< the largest of its particles [m]
  };

  /// Those that elements around the particle may meet, ascending.
  [[nodiscard]] std::vector<Index> near_obstacles(Index particle) const;
  void append_pushes(Index patch, const PatchSafeRegions& regions, const Way& way, std::vector<Push>& pushes) const;
  void append_carried_around(Index patch, const Points& from, double lift, std::vector<MovedVertex>& corners) const;
  /// Whether a particle that obstacle k carries to `place` would pass another one.
  [[nodiscard]] bool leads_through_another(Index k, Index particle, const Vector3& from, const Vector3& place) const;
  /// An obstacle that moves and that an element around the particle may touch; kNone if there is none.
  [[nodiscard]] Index leans_on(Index particle) const;
  void set_passing(PermittedCrossings corners);
  void append_passing(Index patch, const PatchSafeRegions& regions, const Points& from, PermittedCrossings& passing) const;
  [[nodiscard]] bool is_overstretched(const Element& element, const Points& positions) const;
  [[nodiscard]] bool is_passing(Index k, Index particle) const {
    return passing_[static_cast<std::size_t>(k)][static_cast<std::size_t>(particle)] != 0;
  }
  void find_near(Index patch, const Way& way, double carried);
  void append_restless(Index patch, const PatchSafeRegions& regions);
  [[nodiscard]] PatchPaths paths(Index patch, Index obstacle, const Way& way) const;
  [[nodiscard]] RegionDemand demand(const Patch& patch, Index obstacle, const Way& way) const;
  void find_contacts_of(const std::vector<Index>& patches, const Way& way, std::vector<Contact>& contacts);
  void append_particle_contacts(Index patch, PatchSafeRegions& regions, const Way& way, double margin, double reach);
  void append_element_contacts(Index patch, PatchSafeRegions& regions, const Way& way, const RegionDemand& demanded, double margin);
  [[nodiscard]] std::span<const PatchSlot> slots_of(Index particle) const;
  /// Ascending.
  [[nodiscard]] std::vector<Index> patches_around(const std::vector<Index>& particles) const;
  [[nodiscard]] const std::vector<Index>& particles_of(Index patch) const {
    return surface_.patches[static_cast<std::size_t>(patch)].particles;
  }

  const ObstacleSet& set_;
  const CollisionSurface& surface_;
  double margin_;
  bool ahead_ = false;  ///< see look_ahead
  Points rest_;
  std::vector<Patch> patches_;
  PermittedCrossings permitted_crossings_;
  std::vector<std::vector<char>> passing_;  ///< by obstacle, by particle: whether the one lets the other through
};

}  // namespace sprung
