// Particles that are in each other's way, in groups that move on together.
#pragma once

#include "collision/impact_zones/moved_plane.h"
#include "collision/obstacle_regions/kinematic_anchor.h"

#include <span>
#include <vector>

namespace sprung {

/// Particles that lean on obstacles, and those that obstacles hold fast; both ascending by particle.
struct ParticleDisplacements {
  std::vector<ParticleDisplacement> carried{};
  std::vector<KinematicAnchor> anchors{};
};

/// Each group has a motion that all its particles share, after which they are to each other as they were before, and a fraction of
/// the ways from there to their targets that they may go.
class MotionGroups {
 public:
  /// No particle is held yet. Pinned ones (not 0) never are. Positions [m], 3 x n. Keeps references to all.
  MotionGroups(const Points& before, const Points& targets, const std::vector<char>& pinned, const ParticleDisplacements& carriers);

  /// Makes these particles, and the groups that they are in, one group; pinned ones among them lead it. A group that is one already
  /// may not leave the motion that it shares any more. Returns whether anything has changed.
  bool unite(std::span<const Index> particles);

  /// Finds the groups' motions: the mean of those of pinned particles that lead it or, if it may not leave that, their rigid
  /// motion, if they have one; else the common motion of its anchors, which it may not leave; else the mean of its carried
  /// particles; else what its particles' ways have in common: their mean, less the part that their spread is of it, so that a
  /// falling cloth is not held back and a resting one not carried away by what hits it. Fractions are 1 again, except of groups
  /// that may not leave it.
  void find_motions();

  /// A group's number from 0, or kNone for a particle that is not held, as find_motions() found it.
  [[nodiscard]] Index group(Index particle) const { return number_[static_cast<std::size_t>(particle)]; }
  [[nodiscard]] bool holds(Index particle) const { return parent_[static_cast<std::size_t>(particle)] != kNone; }
  [[nodiscard]] const std::vector<Index>& particles() const { return held_; }  ///< in the order in which they were held

  /// Where a particle goes with its group's motion alone; the target of one that is not held.
  [[nodiscard]] Vector3 start(Index particle) const;
  /// Where a particle ends that has gone its group's fraction of the way to its target as well.
  [[nodiscard]] Vector3 end(Index particle) const;

  /// Whether a group that may not leave its motion takes a pin to where that goes, but for a miss [m]: it moves as they all do.
  [[nodiscard]] bool takes_along(Index group, Index pin, double miss) const;

  /// Whether any group's motion may be more than a translation.
  [[nodiscard]] bool turn() const;

  /// The plane that the group takes along; one that stays for none.
  [[nodiscard]] MovedPlane carried(Index group, const Vector3& normal) const;

  /// Whether the group goes along with anchors.
  [[nodiscard]] bool is_anchored(Index group) const { return groups_[static_cast<std::size_t>(group)].anchored; }

  [[nodiscard]] double fraction(Index group) const { return groups_[static_cast<std::size_t>(group)].fraction; }
  void limit_fraction(Index group, double fraction);

 private:
  struct Group {
    AffineTransform motion = AffineTransform::Identity();
    double fraction = 1.0;
    bool turned = false;  ///< the motion may be more than a translation
    bool anchored = false;
  };
  struct Lead {
    Index follower;
    Index pin;
  };

  [[nodiscard]] Index root(Index particle) const;
  [[nodiscard]] bool is_led(Index root_particle, Index pin) const;
  void number_groups();
  void find_means(const std::vector<std::vector<Index>>& pins);
  /// By group, ascending.
  [[nodiscard]] std::vector<std::vector<Index>> leading_pins() const;
  void anchor_groups(const std::vector<std::vector<Index>>& pins);
  /// Those of groups that may not leave the motion that they share.
  void let_pins_turn(const std::vector<std::vector<Index>>& pins);

  const Points& before_;
  const Points& targets_;
  const std::vector<char>& pinned_;
  const ParticleDisplacements& carriers_;
  std::vector<Index> parent_;  ///< by particle: another of its group or itself; kNone when it is not held
  std::vector<Index> held_;
  std::vector<char> stopped_;  ///< by particle that is its own parent
  std::vector<Lead> leads_;    ///< by pinned particles
  std::vector<Index> number_;  ///< of the group, by particle; kNone when it is not held
  std::vector<Group> groups_;
};

}  // namespace sprung
