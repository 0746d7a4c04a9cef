// The step filter: clips positions so that no element of the network crosses an obstacle or another element.
//
// An element whose corners stay inside its safe region, which is convex and contains nothing of the obstacle, does not cross the
// obstacle. So each particle is clipped on its own, to the regions of all elements that it is a corner of ("divide and truncate";
// compare the CCD filter of IPC, Li 2020). Between elements, division planes replace the regions.
#pragma once

#include "base/files/binary_archive.h"
#include "collision/core/contact.h"
#include "collision/obstacle_regions/permitted_crossing.h"
#include "collision/obstacles/obstacle_frame.h"
#include "collision/surface/collision_surface.h"
#include "collision/truncation/truncation_result.h"

#include <functional>
#include <memory>
#include <vector>

namespace sprung {

class StepTruncation {
 public:
  /// Finds contacts up to `margin` [m] beyond their gap. Elements of one body that are near at `rest` [m], 3 x n, may stay as near.
  /// Frames in later calls must be those of `obstacles`.
  StepTruncation(const ObstacleSet& obstacles, CollisionSurface surface, const Points& rest, double margin);
  ~StepTruncation();
  StepTruncation(StepTruncation&&) noexcept;
  StepTruncation& operator=(StepTruncation&&) noexcept;

  /// Whether there is anything that the network may touch: obstacles, other bodies, itself.
  [[nodiscard]] bool can_collide() const;

  /// Whether elements of two bodies may touch.
  [[nodiscard]] bool bodies_can_collide() const;

  /// Replaces the motions of all particles: pins began or ended, or particles fell asleep or woke. All else that is kept between
  /// steps is discarded, permitted crossings too, so that the next step has the same results as with a new object.
  void set_motions(ParticleMotions motions);

  // `obstacles` is the frame of the step.

  /// Begins a step from `before`, where nothing crosses, to `after`, the target at the end of the step [m], 3 x n: updates safe
  /// regions, permitted crossings and the contacts between elements.
  void begin_step(const ObstacleFrame& obstacles, const Points& before, const Points& after);

  /// Crossings that are permitted because a pin pulls an element through an obstacle.
  [[nodiscard]] const PermittedCrossings& permitted_crossings() const;
  /// Discards cached regions and restores the permitted crossings. Call it after the state was rolled back.
  void roll_back(const PermittedCrossings& permitted);

  /// What is kept from step to step, apart from the permitted crossings.
  void save(ByteWriter& to) const;
  /// Call it after roll_back(). Throws BytesError if this was not written for the same surface and obstacles; call roll_back()
  /// again then.
  void load(BinaryReader& from);

  /// The contacts of the step: of particles with obstacles (see ObstacleFrame::contacts), of obstacles with the inside of edges and
  /// faces, and of the network's elements with each other. The same order for any number of threads. Requires begin_step() with the
  /// same positions. Valid until the next call.
  [[nodiscard]] const std::vector<Contact>& contacts(const ObstacleFrame& obstacles, const Points& before, const Points& after);

  /// Finds the contacts with obstacles again around the particles that the last truncate() stopped. For use inside `relax`.
  [[nodiscard]] FreshContacts renewed_contacts(const ObstacleFrame& obstacles, const Points& before, const Points& after);

  /// Moves particles after some were stopped [m]. Returns false when it has nothing left to move, which ends truncate().
  using Relax = std::function<bool(Points& positions)>;

  /// Clips `after` so that no element crosses an obstacle or another element. A particle that would leave a safe region moves to a
  /// nearby admissible position. If surfaces close in on a particle, the interval is subdivided. A particle without an admissible
  /// position moves with the obstacle and is counted as infeasible. Fixed particles and positions that are not finite do not
  /// change.
  ///
  /// While obstacles stop particles, `relax` may move all particles again; they are then clipped from where they are safe. The
  /// result describes the last round. May be called again in a step with other positions, but not after the step was subdivided.
  /// Requires begin_step() if elements of the network may touch.
  TruncationResult truncate(const ObstacleFrame& obstacles, const Points& before, Points& after, const Relax& relax = {});

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sprung
