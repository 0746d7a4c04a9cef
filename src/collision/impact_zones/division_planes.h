// Moving planes that keep the sides of pairs apart.
//
// A plane with the pair's normal separates the sides while particles move straight, if it does at the step's begin and end: what
// lies between the sides along a fixed direction is a concave function of time. So only the end of the step is looked at, but for
// what gives way: see turning_plane.h.
#pragma once

#include "collision/impact_zones/half_space_relaxation.h"
#include "collision/impact_zones/motion_groups.h"
#include "collision/safe_regions/safe_region.h"

#include <span>
#include <vector>

namespace sprung {

/// Particles that would pass each other on their way to their targets are held: each has a place where it may always end, and half-
/// spaces within which it may go on from there.
class DivisionPlanes {
 public:
  /// Begins a step: nothing is held. Held sides keep `kept` [m] between them where they can; for the other arguments see
  /// MotionGroups. Keeps references to them.
  DivisionPlanes(const Points& before, const Points& targets, const std::vector<char>& pinned,
                 const ParticleDisplacements& carriers, double kept);

  /// Holds the particles of pairs that would pass each other where they are to end now. Returns whether any end has changed: then
  /// it is to be called again, with the pairs that these ends may touch.
  /// Pairs whose plane does not do any more get a better one, if there is one.
  [[nodiscard]] bool hold(std::vector<ContactStencil>& pairs);

  /// Lets those that pins drag through each other give way instead, and what is then in their way. Returns whether any end has
  /// changed: then it is to be called again, with the pairs that these ends may touch. Requires that hold() returned false.
  [[nodiscard]] bool give_way(std::vector<ContactStencil>& pairs);

  /// Whether pairs were turned, and their normals not.
  [[nodiscard]] bool turns() const { return gives_way_ || groups_.turn(); }

  /// Gives a new normal to those pairs whose own does not separate them where the step begins.
  void renew_normals(std::vector<ContactStencil>& pairs) const;

  /// Where particles may end: their targets, or, for those that are held, a place on the way [m].
  [[nodiscard]] const Points& ends() const { return ends_; }

  /// In any order.
  [[nodiscard]] std::vector<Index> held() const;

  /// Held particles that anchors take along, in any order.
  [[nodiscard]] std::vector<Index> taken_along() const;

  /// Particles of pairs that pass each other all the same, because pins that go different ways drag them; pins too, in any order,
  /// some more than once. Requires that hold() and give_way() returned false.
  [[nodiscard]] const std::vector<Index>& passing() const { return passing_; }

  /// What bounds a held particle at the step's end.
  struct Bound {
    Index particle = kNone;
    HalfSpace half_space;
  };
  /// The planes of all pairs that have a held particle, as bounds of the held ones, ascending by particle. All ends are within.
  [[nodiscard]] std::vector<Bound> bounds(const std::vector<ContactStencil>& pairs) const;

 private:
  /// Numbers of the pairs that their own normals do not keep apart, and that pass each other. They get better normals, if there are
  /// any.
  template <class Passes>
  [[nodiscard]] std::vector<Index> find_passing(std::vector<ContactStencil>& pairs, const Passes& passes) const;
  [[nodiscard]] bool passes(const ContactStencil& pair) const;
  /// Whether the pair is pins alone, which go as one rigid thing.
  [[nodiscard]] bool is_carried(const ContactStencil& pair) const;
  [[nodiscard]] bool is_pinned(Index i) const { return pinned_[static_cast<std::size_t>(i)] != 0; }
  [[nodiscard]] bool is_held(Index i) const { return groups_.holds(i) || is_aside_[static_cast<std::size_t>(i)] != 0; }
  /// The group that all of the pair is in, or that takes along what of it is pinned; kNone if there is none. The sides are `gap`
  /// [m] apart when the step begins.
  [[nodiscard]] Index group_of(const ContactStencil& pair, double gap) const;
  /// With the normal that it has after its group's motion.
  [[nodiscard]] ContactStencil turned(ContactStencil pair, Index group) const;
  void limit_groups(const std::vector<ContactStencil>& pairs);
  void begin_at_rest();
  void note_passing(const ContactStencil& pair);
  void append_bounds(const ContactStencil& pair, const RotatingPlane& plane, std::vector<Bound>& found) const;
  void append_bounds(const ContactStencil& pair, const MovedPlane& plane, std::vector<Bound>& found) const;
  void append_bounds(const ContactStencil& pair, const Vector3& after, const Vector3& earlier, std::vector<Bound>& found) const;

  const Points& before_;
  const Points& targets_;
  const std::vector<char>& pinned_;
  MotionGroups groups_;
  Points ends_;
  std::vector<Index> passing_;
  SeparationTolerance rule_;
  HalfSpaceRelaxation way_;
  bool gives_way_ = false;
  int rounds_ = 0;              ///< of giving way
  std::vector<Index> aside_;    ///< particles of no group that gave way
  std::vector<char> is_aside_;  ///< by particle
};

}  // namespace sprung
