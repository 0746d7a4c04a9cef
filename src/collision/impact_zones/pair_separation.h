// Separation of the network's elements: bodies that collide with themselves and with each other.
//
// Each pair of elements that may touch in a step gets a moving plane, and each particle stays on its side of the planes. If all
// particles move linearly, elements that do not cross at the step's begin do not cross at its end.
#pragma once

#include "collision/core/contact.h"
#include "collision/impact_zones/division_planes.h"
#include "collision/pairs/neighbour_list.h"
#include "collision/surface/collision_surface.h"

#include <span>
#include <vector>

namespace sprung {

class PairSeparation {
 public:
  /// Finds contacts up to `margin` [m] beyond their gap. Elements of a body that are near each other at `rest` [m], 3 x n, may stay
  /// as near. Keeps a reference to the surface.
  PairSeparation(const CollisionSurface& surface, const Points& rest, double margin);

  /// Begins a step from `before` [m], 3 x n, where nothing crosses, to expected positions `after`. Appends the contacts of the
  /// step: their gap is the mean of the two thicknesses, but at most `most_gap`.
  void begin_step(const Points& before, const Points& after, std::vector<Contact>& contacts);

  /// Discards the data kept between steps. Call it if the next step does not begin where the last one ended, or if the motions of
  /// particles were replaced.
  void forget();

  /// Begins a substep from `before` [m], where nothing crosses, to expected positions `after`. The calls that follow refer to it.
  void begin_substep(const Points& before, const Points& after);

  /// Constrains the particles that would pass each other on the path to their `targets` [m], and returns them, ascending. All
  /// others may end at their targets; fixed particles do so in any case. `displacements` are those that obstacles impose.
  /// Requires begin_step() or begin_substep() with the same `before`.
  const std::vector<Index>& constrain(const Points& before, const Points& targets, const ParticleDisplacements& displacements = {});

  /// A position [m] where the constrained particle may always end.
  [[nodiscard]] Vector3 safe_position(Index particle) const;

  /// Appends the half-spaces within which the constrained particle may end; it also has to stay in its sphere. Requires
  /// constrain().
  void append_half_spaces(Index particle, std::vector<HalfSpace>& half_spaces) const;
  struct Sphere {
    Vector3 center;
    double radius;
  };
  [[nodiscard]] Sphere sphere(Index particle) const;

  /// Constrained particles of groups that move with an obstacle, in any order.
  [[nodiscard]] const std::vector<Index>& moved_with_obstacle() const;

  /// Whether an element of the particle crosses another one wherever the particle ends, because pins with different motions drag
  /// them.
  [[nodiscard]] bool crosses(Index particle) const;

  /// Fixed particles of such elements, ascending. A driven particle counts only if one of its elements has a corner that is not
  /// driven: elements that pins drive as a whole may cross each other on purpose.
  [[nodiscard]] std::vector<Index> crossing_fixed() const;

  /// Whether the constrained particle may end at p [m]: it is in all half-spaces and in the sphere.
  [[nodiscard]] bool allows(Index particle, const Vector3& p) const;

  /// Appends, for each pair of two bodies with a constrained particle, the contact between its closest points at the step's begin
  /// `before` [m].
  void append_closest_contacts(const Points& before, std::vector<Contact>& contacts);

 private:
  template <Same<PairSeparation> S, class Visit>
  friend void visit_members(S& p, const Visit& visit) {
    visit(p.list_, p.rotated_);
  }

  [[nodiscard]] std::span<const DivisionPlanes::Bound> bounds_of(Index particle) const;
  [[nodiscard]] Index body_at(Index particle) const;

  const CollisionSurface& surface_;
  NeighbourList list_;
  Points ends_;
  std::vector<Index> constrained_;  ///< ascending
  std::vector<Index> crossing_;     ///< ascending
  std::vector<DivisionPlanes::Bound> bounds_;
  std::vector<Index> moved_with_obstacle_;
  bool rotated_ = false;  ///< pairs may have rotated without their normals
};

}  // namespace sprung
