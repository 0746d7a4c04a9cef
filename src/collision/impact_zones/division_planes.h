// Planar divide and truncate: moving planes between the sides of pairs.
//
// If particles move linearly and a plane with a fixed normal separates the sides at the step's begin and end, it does so at all
// times: the gap along a fixed direction is a concave function of time. So only the step's end is checked.
#pragma once

#include "collision/core/half_space.h"
#include "collision/impact_zones/motion_groups.h"
#include "collision/pairs/contact_stencil.h"

#include <algorithm>
#include <vector>

namespace sprung {

/// The gap that the sides of a pair keep in a step.
struct SeparationTolerance {
  double thickness_kept = 0.0;  ///< gap that constrained sides keep if they can [m]
  double clearance = 0.0;       ///< a smaller gap may come from rounding [m]

  /// Smallest gap at the end of a step [m]. A gap that is already smaller may not shrink, or it would vanish over many steps.
  [[nodiscard]] double least() const { return 0.5 * clearance; }

  /// Smallest gap at the end of a step that begins with the gap `begun`, less a bound of the step's rounding [m].
  [[nodiscard]] double needed(double begun) const { return std::min(begun, least()) - kRounding * clearance; }

  /// The gap that constrained sides keep if the step begins with the gap `begun` [m].
  [[nodiscard]] double kept(double begun) const { return std::min(begun, std::max(clearance, thickness_kept)); }

 private:
  static constexpr double kRounding = 0x1p-18;
};

/// Constrains particles that would pass each other on the path to their targets: each gets a position where it may always end, and
/// half-spaces that limit how far it may move from there.
class DivisionPlanes {
 public:
  /// Begins a step without constraints. Constrained sides keep a gap of `kept` [m] if they can. For the other arguments, to which
  /// it keeps references, see MotionGroups.
  DivisionPlanes(const Points& before, const Points& targets, const ParticleMotions& motions,
                 const ParticleDisplacements& displacements, double kept);

  /// Constrains the particles of pairs that would pass each other on the path to their current ends. A pair whose normal no longer
  /// separates it gets a new one. Returns whether any end has changed. If so, the caller adds the pairs that the new ends may
  /// touch, and calls it again. This terminates: see MotionGroups::unite().
  [[nodiscard]] bool constrain(std::vector<ContactStencil>& pairs);

  /// Whether pairs may have rotated without their normals.
  [[nodiscard]] bool rotates() const { return groups_.any_rotates(); }

  /// Renews the normals that do not separate their pairs at the step's begin.
  void renew_normals(std::vector<ContactStencil>& pairs) const;

  /// Ends that are always allowed [m], 3 x n: the targets of free particles, other positions for constrained ones.
  [[nodiscard]] const Points& ends() const { return ends_; }

  /// Constrained particles, in any order.
  [[nodiscard]] const std::vector<Index>& constrained() const { return groups_.particles(); }

  /// Constrained particles of groups with blocked vertices, in any order.
  [[nodiscard]] std::vector<Index> moved_with_obstacle() const;

  /// Particles of pairs that still cross, because pins with different motions drag them. Includes pins; in any order,
  /// some more than once. Requires that constrain() returned false.
  [[nodiscard]] const std::vector<Index>& crossing() const { return crossing_; }

  /// A half-space for the end of one particle.
  struct Bound {
    Index particle = kNone;
    HalfSpace half_space;
  };
  /// The planes of all pairs as bounds of their constrained particles, ascending by particle. All ends are within them.
  [[nodiscard]] std::vector<Bound> bounds(const std::vector<ContactStencil>& pairs) const;

 private:
  /// Numbers of the pairs that cross. First renews the normals that do not separate their pairs at the end.
  [[nodiscard]] std::vector<Index> find_crossing(std::vector<ContactStencil>& pairs) const;
  [[nodiscard]] bool crosses(const ContactStencil& pair) const;
  /// Whether all particles of the pair are fixed and move as a rigid body.
  [[nodiscard]] bool is_fixed_rigidly(const ContactStencil& pair) const;
  /// The group with all free particles of the pair, if its motion also fits the fixed ones; else kNone. The sides begin the step
  /// with this `gap` [m].
  [[nodiscard]] Index group_of(const ContactStencil& pair, double gap) const;
  /// The pair with its normal after the group's motion.
  [[nodiscard]] ContactStencil moved(ContactStencil pair, Index group) const;
  void limit_groups(const std::vector<ContactStencil>& pairs);
  void append_bounds(const ContactStencil& pair, const MovedPlane& plane, std::vector<Bound>& found) const;
  void append_bounds(const ContactStencil& pair, const Vector3& after, const Vector3& earlier, std::vector<Bound>& found) const;

  const Points& before_;
  const Points& targets_;
  const ParticleMotions& motions_;
  MotionGroups groups_;
  Points ends_;
  std::vector<Index> crossing_;
  SeparationTolerance tolerance_;
};

}  // namespace sprung
