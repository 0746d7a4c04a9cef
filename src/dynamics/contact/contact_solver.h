// Solves contacts of all kinds for positions and velocities: of particles, of points of segments and triangles, of pairs of
// elements.
//
// Friction is a displacement, not a velocity: it reduces the motion along the surface in the positions too, so that a particle at
// rest on a slope does not creep by g sin(angle) dt^2 each step. The velocity follows from the position.
//
// Passes find a load only roughly, so that friction suffices in some steps and not in others. Without memory particles creep.
// Friction with an obstacle therefore takes a particle back to where it stuck, as do the springs between grains of Cundall and
// Strack (1979), within Coulomb's bound.
#pragma once

#include "collision/core/contact.h"
#include "collision/obstacles/obstacle_frame.h"
#include "dynamics/contact/contact_constraint_set.h"
#include "dynamics/contact/contact_materials.h"
#include "dynamics/integrators/constrained_directions.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/integrators/step_motion.h"
#include "dynamics/state/simulation_state.h"
#include "network/model/spring_network.h"

#include <tuple>
#include <vector>

namespace sprung {

class ContactSolver {
 public:
  /// Keeps references to the network and the obstacles.
  ContactSolver(const SpringNetwork& network, const ObstacleSet& obstacles);

  /// Begins a step with these contacts; `frame` has the obstacles in its interval. Contacts of few particles are solved first,
  /// those of equal count in the given order. Contacts of pinned particles alone are dropped, and so are contacts closer than the
  /// gap whose weight is nearly all on pins. No contact with an obstacle turns an element about its pins by more than a radian.
  void start(const ObstacleFrame& frame, const std::vector<Contact>& contacts, const StepMotion& motion);

  /// Replaces the contacts of some patches within the step. A contact between the same particles and obstacle as before keeps its
  /// accumulated push and friction.
  void renew(const FreshContacts& fresh, const StepMotion& motion);

  /// Adds contacts between elements to those of the step.
  void add(const std::vector<Contact>& contacts, const StepMotion& motion);

  /// One Gauss-Seidel pass. Each contact moves its particles, weighted by inverse mass, out to its gap. Friction acts on the
  /// motion along the surface relative to the touched point: it stops that motion while static friction times the push suffices,
  /// and otherwise removes kinetic friction times the push (Coulomb). Pinned particles do not move. Returns the largest change of
  /// a push relative to the gap.
  double project(Points& positions);

  /// Computes the velocities of touching contacts by impulses, which conserve momentum between elements. Along the normal,
  /// relative to the touched surface, a contact leaves with restitution times the impact speed, or rests (see `settled_speeds`). A
  /// push out of the gap adds no speed. Requires the motion that `start` was given, and velocities recovered from positions.
  void settle_velocities(const StepMotion& motion, SimulationState& state, const Integrator& integrator);

  /// Sets the slip of the state at the end of the step: of a particle that an obstacle pushes, its displacement along the obstacle
  /// since it stuck, at most friction times the push; of others 0. If several contacts push a particle, the one with the largest
  /// bound of friction counts.
  void note_slip(const StepMotion& motion, SimulationState& state) const;

  /// Adds the supports of particles that obstacles pushed in this step, and the contacts between elements that pushed.
  void constrain_pushed(const StepMotion& motion, ConstrainedDirections& constrained) const;

  /// Records the impulses of the contacts of a step that ended on the pinned particles among theirs. With an integrator that
  /// responds to contact they are those of the passes, not of its response. Requires settle_velocities().
  void record(const StepMotion& motion, const ImpulseRecorder& recorder) const;

  /// Adds to `impulses` [N s], 3 x n, what contacts gave each particle by the passes over positions so far.
  void add_pushes(const StepMotion& motion, Points& impulses) const;
  /// The same by the passes over velocities. Requires settle_velocities().
  void add_settled(Points& impulses) const;

  /// Particles pushed in this step, ascending.
  [[nodiscard]] std::vector<Index> pushed() const;

  /// The normals of touching contacts at the end of the last step, for each particle that they can move.
  [[nodiscard]] std::vector<ContactNormal> normals() const;

 private:
  /// Calls `visit(particle, m u)` for each particle of a row: u is the particle's part of `moved`, the change of the row's weighted
  /// sum; m is its mass.
  template <std::size_t n, class Visit>
  void for_shares(const ContactConstraint<n>& row, const Vector3& moved, const Visit& visit) const;
  /// Adds contacts of n particles from index `begin` on; those before it stay.
  template <std::size_t n>
  void fill(ContactConstraintSet<n>& set, std::size_t first, const std::vector<Contact>& contacts, const StepMotion& motion);
  template <std::size_t n>
  void fill_one(const Contact& contact, const ContactMaterial& pair, const StepMotion& motion, ContactConstraintSet<n>& set,
                std::size_t slot);
  template <std::size_t n>
  [[nodiscard]] ElementContact element_contact(const ContactConstraint<n>& row, const ContactGoal& goal) const;
  [[nodiscard]] Vector3 moved_with_obstacle(const Contact& contact, const Vector3& from) const;
  [[nodiscard]] Vector3 rotated_with_obstacle(Index obstacle, const Vector3& direction) const;

  const SpringNetwork& network_;
  const ObstacleSet& obstacles_;
  ContactMaterials materials_;
  std::vector<RigidTransform> obstacle_motions_;  ///< of each obstacle, from the beginning of the step to its end
  using Sets = std::tuple<ContactConstraintSet<1>, ContactConstraintSet<2>, ContactConstraintSet<3>, ContactConstraintSet<4>>;
  Sets sets_;
  Sets former_sets_;              ///< contacts that renew() removes
  std::vector<Index> order_;      ///< contacts with as many particles as the set that is being filled
  std::vector<Index> first_row_;  ///< see ContactConstraintSet::warm_start
};

}  // namespace sprung
