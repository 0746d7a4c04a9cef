// What keeps the elements of the network from crossing each other: bodies that collide with themselves, and bodies with one
// another.
//
// Pairs of corner and face and of edge and edge that may touch in a step get a moving plane each, and particles are kept, each on
// its own, on their side of it: what does not cross at the step's begin does not at its end, when all particles move straight.
#pragma once

#include "collision/core/contact.h"
#include "collision/impact_zones/motion_groups.h"
#include "collision/pairs/neighbour_list_counts.h"
#include "collision/safe_regions/safe_region.h"
#include "collision/surface/collision_surface.h"

#include <memory>
#include <span>
#include <vector>

namespace sprung {

class PairSeparation {
 public:
  /// Finds contacts up to `margin` [m] beyond their gap. What is near in one body at `rest` [m], 3 x n, may stay as near. Keeps a
  /// reference to the surface.
  PairSeparation(const CollisionSurface& surface, const Points& rest, double margin);
  ~PairSeparation();
  PairSeparation(PairSeparation&&) noexcept;
  PairSeparation& operator=(PairSeparation&&) noexcept;

  /// A step begins at `before` [m], 3 x n, where nothing crosses, and is about to end at `after`. Appends the contacts on the way:
  /// their gap is the mean of the two thicknesses, but at most `most_gap`.
  void begin_step(const Points& before, const Points& after, std::vector<Contact>& contacts);

  /// The next step does not begin where the last one ended.
  void forget();

  /// A part of the step begins at `before` [m], where nothing crosses, and is about to end at `after`: what follows is for the
  /// part.
  void begin_part(const Points& before, const Points& after);

  /// Finds which particles would pass each other on their way to `targets` [m]; all others may go there. Pinned particles do so in
  /// any case. Returns those that are held, ascending. Requires begin_step() or begin_part() with the same `before`.
  const std::vector<Index>& hold(const Points& before, const Points& targets, const ParticleDisplacements& carriers = {});

  /// Where a held particle may end in any case [m].
  [[nodiscard]] Vector3 safe_place(Index particle) const;

  /// Where else a held particle may end: within these half-spaces, which are appended, and this ball. Requires hold().
  void append_half_spaces(Index particle, std::vector<HalfSpace>& half_spaces) const;
  struct Ball {
    Vector3 center;
    double radius;
  };
  [[nodiscard]] Ball ball(Index particle) const;

  /// Held particles that anchors take along, in any order.
  [[nodiscard]] const std::vector<Index>& taken_along() const;

  /// Whether a held particle is one of a side that passes another wherever it ends: pins that go different ways drag it.
  [[nodiscard]] bool passes(Index particle) const;

  /// Pinned particles of sides that pass each other wherever they end, if they have elements that not pins alone hold; ascending.
  [[nodiscard]] std::vector<Index> passing_pins() const;

  /// Whether a held particle may end at p: it is within both.
  [[nodiscard]] bool allows(Index particle, const Vector3& p) const;

  /// Appends where other bodies are nearest to held particles, or to what is between those, at `before` [m], where the step begins.
  void append_meetings(const Points& before, std::vector<Contact>& meetings);

  [[nodiscard]] NeighbourListCounts counts() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sprung
