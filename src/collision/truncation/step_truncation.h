// What keeps the network's elements from crossing obstacles: convex free space around each of them, kept from step to step.
//
// An element that stays within what its region's box and half-spaces have in common cannot cross the obstacle, because that is
// convex and holds nothing of it. So each particle is kept, on its own, within the regions of all elements that have it as a
// corner.
#pragma once

#include "collision/core/contact.h"
#include "collision/obstacle_regions/permitted_crossing.h"
#include "collision/obstacles/environment.h"
#include "collision/surface/collision_surface.h"
#include "collision/truncation/truncation_result.h"

#include <functional>
#include <memory>
#include <vector>

namespace sprung {

class StepTruncation {
 public:
  /// Finds contacts up to `margin` [m] beyond their gap. What is near in one body at `rest` [m], 3 x n, may stay as near. Keeps a
  /// reference to the environment.
  StepTruncation(Environment& environment, CollisionSurface surface, const Points& rest, double margin);
  ~StepTruncation();
  StepTruncation(StepTruncation&&) noexcept;
  StepTruncation& operator=(StepTruncation&&) noexcept;

  /// Whether there is anything that the network may meet: obstacles, other bodies, itself.
  [[nodiscard]] bool can_collide() const;

  /// Whether elements of two bodies may meet.
  [[nodiscard]] bool bodies_can_collide() const;

  /// Makes the regions hold the elements on their way from `before`, where nothing crosses, to where they are about to be at the
  /// end of the environment's interval [m].
  void follow(const Points& before, const Points& after);

  /// What obstacles let through, because pins drag it through them.
  [[nodiscard]] const PermittedCrossings& permitted_crossings() const;
  /// The next step does not begin where the last one ended, but where this was let through.
  void roll_back(const PermittedCrossings& permitted);

  /// Whether contacts of elements at pins are found on their whole way, wherever it begins. Truncation cannot help them, as a pin
  /// goes where it goes; but the farther off a contact is found, the more often nothing would have touched.
  void look_ahead(bool ahead);

  /// Contacts of particles (see Environment::contacts), and of obstacles with the inside of edges and faces: an edge over a spike,
  /// a face over a corner; then those of the network's elements with each other. Same order for any number of threads. Requires
  /// follow() with the same positions.
  /// Valid until it is asked again.
  [[nodiscard]] const std::vector<Contact>& contacts(const Points& before, const Points& after);

  /// Contacts with obstacles around what truncate() has stopped, found anew while it relaxes.
  [[nodiscard]] FreshContacts renewed_contacts(const Points& before, const Points& after);

  /// Moves particles once more after some were stopped [m]; returns false when it has nothing to move.
  using Relax = std::function<bool(Points& positions)>;

  /// The last word on positions: moves each particle that would take an element out of its regions to a place near `after` where it
  /// does not, taking obstacles that close in on it, or on what is in its way, along in smaller parts of the interval. A particle
  /// that found none stays with an obstacle that carries it. Particles that follow their pins, and positions that
  /// are not finite, are left alone.
  ///
  /// What obstacles stop, `relax` may lead elsewhere, and its neighbours after it, again and again: all go on from where they are
  /// safe. The result tells of the last time. It may be asked again in a step, of other positions, but not after it went in parts.
  TruncationResult truncate(const Points& before, Points& after, const Relax& relax = {});

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sprung
