// Planar divide and truncate: moving planes between the sides of pairs.
//
// If particles move linearly and a plane with a fixed normal separates the sides at the step's begin and end, it does so at all
// times: the gap along a fixed direction is a concave function of time. So only the step's end is checked. Relaxed pairs get
// rotating planes instead: see rotating_plane.h.
#pragma once

#include "collision/impact_zones/half_space_relaxation.h"
#include "collision/impact_zones/motion_groups.h"
#include "collision/safe_regions/safe_region.h"

#include <span>
#include <vector>

namespace sprung {

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

  /// Relaxes the ends of particles that pins with different motions drag through each other, and of the particles that they may
  /// touch. Returns whether any end has changed. If so, the caller adds the pairs that the new ends may touch, and calls it again:
  /// at most six times. Requires that constrain() returned false.
  [[nodiscard]] bool relax(std::vector<ContactStencil>& pairs);

  /// Whether pairs may have rotated without their normals.
  [[nodiscard]] bool rotates() const { return relaxed_ || groups_.any_rotates(); }

  /// Renews the normals that do not separate their pairs at the step's begin.
  void renew_normals(std::vector<ContactStencil>& pairs) const;

  /// Ends that are always allowed [m], 3 x n: the targets of free particles, other positions for constrained ones.
  [[nodiscard]] const Points& ends() const { return ends_; }

  /// Constrained particles, in any order.
  [[nodiscard]] std::vector<Index> constrained() const;

  /// Constrained particles that move with anchors, in any order.
  [[nodiscard]] std::vector<Index> anchored() const;

  /// Particles of pairs that still pass each other, because pins with different motions drag them. Includes pins; in any order,
  /// some more than once. Requires that constrain() and relax() returned false.
  [[nodiscard]] const std::vector<Index>& passing() const { return passing_; }

  /// A half-space for the end of one particle.
  struct Bound {
    Index particle = kNone;
    HalfSpace half_space;
  };
  /// The planes of all pairs as bounds of their constrained particles, ascending by particle. All ends are within them.
  [[nodiscard]] std::vector<Bound> bounds(const std::vector<ContactStencil>& pairs) const;

 private:
  /// Numbers of the pairs for which `passes` is true. Pairs that their normals do not separate at the end get new ones first.
  template <class Passes>
  [[nodiscard]] std::vector<Index> find_passing(std::vector<ContactStencil>& pairs, const Passes& passes) const;
  [[nodiscard]] bool passes(const ContactStencil& pair) const;
  /// Whether all particles of the pair are fixed and move as a rigid body.
  [[nodiscard]] bool is_fixed_rigidly(const ContactStencil& pair) const;
  [[nodiscard]] bool is_constrained(Index i) const { return groups_.contains(i) || is_aside_[static_cast<std::size_t>(i)] != 0; }
  /// The group with all free particles of the pair, if its motion also fits the fixed ones; else kNone. The sides begin the step
  /// with this `gap` [m].
  [[nodiscard]] Index group_of(const ContactStencil& pair, double gap) const;
  /// The pair with its normal after the group's motion.
  [[nodiscard]] ContactStencil moved(ContactStencil pair, Index group) const;
  void limit_groups(const std::vector<ContactStencil>& pairs);
  void reset_passing_groups();
  void note_passing(const ContactStencil& pair);
  void append_bounds(const ContactStencil& pair, const RotatingPlane& plane, std::vector<Bound>& found) const;
  void append_bounds(const ContactStencil& pair, const MovedPlane& plane, std::vector<Bound>& found) const;
  void append_bounds(const ContactStencil& pair, const Vector3& after, const Vector3& earlier, std::vector<Bound>& found) const;

  const Points& before_;
  const Points& targets_;
  const ParticleMotions& motions_;
  MotionGroups groups_;
  Points ends_;
  std::vector<Index> passing_;
  SeparationTolerance tolerance_;
  HalfSpaceRelaxation relaxation_;
  bool relaxed_ = false;
  int rounds_ = 0;              ///< of relaxation
  std::vector<Index> aside_;    ///< relaxed particles without a group
  std::vector<char> is_aside_;  ///< by particle
};

}  // namespace sprung
