// Contact response by projection: particles are moved out of obstacles, with Coulomb friction; restitution is settled on
// velocities.
//
// Friction is a displacement, not a velocity: what it takes from the motion along the surface it takes from the position too, so
// that a particle at rest on a slope does not creep by g sin(angle) dt^2 each step. The velocity follows from the position.
#pragma once

#include "base/contact_material.h"
#include "collision/environment.h"
#include "dynamics/integrator.h"
#include "network/spring_network.h"

#include <vector>

namespace sprung {

class ContactProjection {
 public:
  /// Keeps references to the network and the environment.
  ContactProjection(const SpringNetwork& network, const Environment& environment);

  /// Finds the contacts of a step of `dt` [s] that began with `before` [m] and `v_before` [m/s] and that the forces alone would end
  /// in `advanced`. Requires that the environment's interval is the step's.
  void find(const Points& before, const Points& v_before, const SimulationState& advanced, double dt);

  /// Moves particles out to the gap of their contacts, and holds or slows their motion along the surface relative to the point that
  /// the obstacle carries: holds it while it is at most static friction times the push, else takes kinetic friction times the
  /// push from it (Coulomb). Pinned particles do not move. Returns the largest push of this pass, as a part of the gap.
  double project(Points& positions);

  /// Moves particles that ended behind a surface back to the side where they were at `before` [m]: the last word on positions.
  void truncate(const Points& before, Points& positions);

  /// Velocities of particles that touch: the part along the normal, relative to the obstacle, becomes restitution times the
  /// approach, or none when the approach is no more than what the forces make in a step or two (rest). A push out of the gap never
  /// speeds a particle up.
  void settle_velocities(SimulationState& state, const Integrator& integrator) const;

  [[nodiscard]] Index contact_count() const;  ///< particles that an obstacle pushed in this step
  [[nodiscard]] Index truncated_count() const { return truncated_; }
  [[nodiscard]] Index squeezed_count() const { return squeezed_; }

 private:
  struct Active {
    Contact contact{};
    ContactMaterial pair{};
    double gap = 0.0;                            ///< kept between particle and surface [m], > 0
    double push = 0.0;                           ///< along the normal, so far in this step [m]
    double held = 0.0;                           ///< what friction has taken from the motion so far [m]
    Vector3 carried = Vector3::Zero();           ///< where the obstacle takes the particle's old position [m]
    Vector3 surface_velocity = Vector3::Zero();  ///< [m/s]
    double approach = 0.0;                       ///< speed towards the obstacle at the step's begin [m/s]
    double leaving = 0.0;                        ///< speed away from it that the forces alone would make [m/s]
  };

  void rub(Active& active, Eigen::Ref<Vector3> position) const;
  [[nodiscard]] double settled_speed(const Active& active, double speed) const;

  const SpringNetwork& network_;
  const Environment& environment_;
  Scalars thickness_;    ///< of each particle [m]
  double margin_ = 0.0;  ///< beyond the gap, for what the passes of a step may move [m]
  std::vector<char> pinned_;
  double dt_ = 0.0;
  std::vector<Active> active_;
  Index truncated_ = 0;
  Index squeezed_ = 0;
};

}  // namespace sprung
