// Motion groups: particles that obstruct each other, and the reference motion that each group shares (impact zones, Provot 1997,
// Harmon et al. 2008).
#pragma once

#include "collision/impact_zones/group_motion.h"
#include "collision/obstacle_regions/blocked_vertex.h"
#include "collision/surface/collision_surface.h"

#include <span>
#include <vector>

namespace sprung {

/// Displacements that obstacles impose, both lists ascending by particle.
struct ParticleDisplacements {
  std::vector<ParticleDisplacement> moved{};  ///< of particles in contact with an obstacle
  std::vector<BlockedVertex> blocked{};       ///< particles that move as if they were part of an obstacle
};

/// Each group has a reference motion, and a fraction: how far its particles may move from their positions after this motion
/// towards their targets. A locked group has the fraction 0, so that only the reference motion moves it.
class MotionGroups {
 public:
  /// Begins without groups. Fixed particles never belong to one. Positions [m], 3 x n. Keeps references to all arguments.
  MotionGroups(const Points& before, const Points& targets, const ParticleMotions& motions,
               const ParticleDisplacements& displacements);

  /// Merges these particles and their groups into one group, which follows the fixed particles among them. If they are one group
  /// already, locks it. Returns whether anything has changed. It returns true a finite number of times, because groups only grow,
  /// gain pins and become locked.
  bool unite(std::span<const Index> particles);

  /// Computes one reference motion per group. The first rule that applies wins: (1) locked group with pins: rigid motion of the
  /// pins, if they have one; (2) pins: mean of their displacements; (3) blocked vertices: their common affine motion, which locks
  /// the group; (4) particles moved by obstacles: mean of their displacements; (5) otherwise: mean displacement, times 1 - variance
  /// / mean^2 or 0, so that a falling cloth is not slowed and a resting one does not follow a body that hits it. Resets the
  /// fractions to 1, and to 0 for locked groups.
  void find_motions();

  /// Number of the particle's group from 0, or kNone, as of the last find_motions().
  [[nodiscard]] Index group(Index particle) const { return number_[static_cast<std::size_t>(particle)]; }
  [[nodiscard]] bool contains(Index particle) const { return parent_[static_cast<std::size_t>(particle)] != kNone; }
  [[nodiscard]] const std::vector<Index>& particles() const {
    return particles_;
  }  ///< of all groups, in the order of their addition

  /// A particle's position after its group's motion alone [m]; its target if it has no group.
  [[nodiscard]] Vector3 start(Index particle) const;
  /// A particle's position after its group's motion and fraction [m]; its target if it has no group.
  [[nodiscard]] Vector3 end(Index particle) const;

  /// Whether the motion of a locked group moves the pin to its target, up to `miss` [m].
  [[nodiscard]] bool moves_to_target(Index group, Index pin, double miss) const;

  /// Whether any group's motion may be more than a translation.
  [[nodiscard]] bool any_rotates() const;

  /// The plane, moved with the group; constant for kNone and for translations.
  [[nodiscard]] MovedPlane moved(Index group, const Vector3& normal) const;

  /// Whether the group has the motion of blocked vertices.
  [[nodiscard]] bool moves_with_obstacle(Index group) const { return groups_[static_cast<std::size_t>(group)].with_obstacle; }

  [[nodiscard]] double fraction(Index group) const { return groups_[static_cast<std::size_t>(group)].fraction; }
  void limit_fraction(Index group, double fraction);

 private:
  struct Group {
    AffineTransform motion = AffineTransform::Identity();
    double fraction = 1.0;
    bool rotates = false;  ///< the motion may be more than a translation
    bool with_obstacle = false;
  };
  struct FixedBy {
    Index particle;  ///< of the group
    Index pin;
  };

  [[nodiscard]] Index root(Index particle) const;
  [[nodiscard]] bool is_fixed_by(Index root_particle, Index pin) const;
  void number_groups();
  void find_means(const std::vector<std::vector<Index>>& pins);
  /// By group; ascending.
  [[nodiscard]] std::vector<std::vector<Index>> pins_of_groups() const;
  void apply_blocked(const std::vector<std::vector<Index>>& pins);
  /// To locked groups.
  void apply_rigid_pins(const std::vector<std::vector<Index>>& pins);

  const Points& before_;
  const Points& targets_;
  const ParticleMotions& motions_;
  const ParticleDisplacements& displacements_;
  std::vector<Index> parent_;  ///< union-find, by particle: another of its group or itself; kNone without a group
  std::vector<Index> particles_;
  std::vector<char> locked_;  ///< by particle that is its own parent
  std::vector<FixedBy> fixed_by_;
  std::vector<Index> number_;  ///< of the group, by particle; kNone without a group
  std::vector<Group> groups_;
};

}  // namespace sprung
