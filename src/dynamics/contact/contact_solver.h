// The response to contacts of every kind: of particles, of points of segments and triangles, of pairs of elements.
//
// Friction is a displacement, not a velocity: what it takes from the motion along the surface it takes from the position too, so
// that a particle at rest on a slope does not creep by g sin(angle) dt^2 each step. The velocity follows from the position.
#pragma once

#include "collision/core/contact.h"
#include "collision/obstacles/environment.h"
#include "dynamics/contact/contact_constraint_set.h"
#include "dynamics/contact/contact_materials.h"
#include "dynamics/integrators/constrained_directions.h"
#include "dynamics/integrators/integrator.h"
#include "dynamics/integrators/step_motion.h"
#include "network/spring_network.h"

#include <tuple>
#include <vector>

namespace sprung {

class ContactSolver {
 public:
  /// Keeps references to the network and the environment.
  ContactSolver(const SpringNetwork& network, const Environment& environment);

  /// Begins a step with these contacts. Those of few particles are answered first, and those of as many in the order given; those
  /// of pinned particles alone never, nor those closer than the gap to the pins that have nearly all of them. No contact with an
  /// obstacle turns an element about its pins by more than a radian. Requires that the environment's interval is the step's.
  void start(const std::vector<Contact>& contacts, const StepMotion& motion);

  /// Goes on with these contacts of their patches in the same step: one between the same as before keeps what it has pushed and
  /// held.
  void renew(const FreshContacts& fresh, const StepMotion& motion);

  /// Adds contacts between elements to those of the step.
  void add(const std::vector<Contact>& meetings, const StepMotion& motion);

  /// One Gauss-Seidel pass: each contact moves its particles, weighted by inverse mass, out to its gap, and friction holds or slows
  /// their motion along the surface, relative to the point that the obstacle or the other element carries: holds it while it is at
  /// most static friction times the push, else takes kinetic friction times the push from it (Coulomb). Pinned particles do not
  /// move. Returns the largest change of a push in this pass, as a part of the gap.
  double project(Points& positions);

  /// Velocities of what touches, by impulses, which keep the momentum of two elements that meet: along the normal, relative to what
  /// is met, it leaves with restitution times the speed of the impact, or rests (see `settled_speeds`). A push out of the gap never
  /// speeds anything up. Requires the motion that the step was begun with, and velocities that are recovered from positions.
  void settle_velocities(const StepMotion& motion, SimulationState& state, const Integrator& integrator);

  /// Adds the normals along which particles were pushed in this step.
  void hold_pushed(ConstrainedDirections& held) const;

  /// Particles that were pushed in this step.
  [[nodiscard]] Index pushed_count() const;

 private:
  /// Contacts of n particles, from the first one on; those before it stay.
  template <std::size_t n>
  void fill(ContactConstraintSet<n>& set, std::size_t first, const std::vector<Contact>& contacts, const StepMotion& motion);
  template <std::size_t n>
  void fill_one(const Contact& contact, const ContactMaterial& pair, const StepMotion& motion, ContactConstraintSet<n>& set,
                std::size_t slot);
  [[nodiscard]] Vector3 carried(const Contact& contact, const Vector3& from) const;

  const SpringNetwork& network_;
  const Environment& environment_;
  ContactMaterials materials_;
  std::vector<RigidTransform> carry_;  ///< of each obstacle, from the step's begin to its end
  using Sets = std::tuple<ContactConstraintSet<1>, ContactConstraintSet<2>, ContactConstraintSet<3>, ContactConstraintSet<4>>;
  Sets sets_;
  Sets former_sets_;              ///< what renew() takes out
  std::vector<Index> order_;      ///< contacts of as many particles as the set that is filled
  std::vector<Index> first_row_;  ///< see ContactConstraintSet::count_on
};

}  // namespace sprung
