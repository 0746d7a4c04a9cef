// Contact response: particles are projected out of obstacles, with Coulomb friction; restitution is settled on velocities.
#pragma once

#include "collision/environment.h"
#include "dynamics/integrator.h"
#include "network/spring_network.h"

#include <vector>

namespace sprung {

class ContactProjection {
 public:
  /// Keeps references to the network and the environment.
  ContactProjection(const SpringNetwork& network, const Environment& environment);

  /// Finds the contacts of a step whose forces alone would take particles from `before` to `advanced` [m]. The environment's
  /// interval must be the step's. `v_before` [m/s] are the velocities at its begin, `v_advanced` those that forces alone make of
  /// them.
  void find(const Points& before, const Points& advanced, const Points& v_before, const Points& v_advanced);

  /// Moves particles out to their gap along each contact's normal, and holds or slows their motion along the surface, relative to
  /// the point that the obstacle carries: wholly while it is at most static friction times the push, else by kinetic friction times
  /// the push (Coulomb). Pinned particles do not move.
  void project(Points& positions);

  /// Moves particles that ended behind a surface back in front of it: the last word on positions.
  void truncate(Points& positions);

  /// Velocities of particles that were pushed: the part along the normal becomes restitution times the approach (none when the
  /// approach is what one step of the forces makes: rest), and never leaves faster than that because of the push.
  void settle_velocities(SimulationState& state, const Integrator& integrator, double dt) const;

  [[nodiscard]] Index contact_count() const;  ///< contacts that pushed in this step
  [[nodiscard]] Index truncated_count() const { return truncated_; }
  [[nodiscard]] Index squeezed_count() const { return squeezed_; }

 private:
  struct Active {
    Contact contact;
    double gap = 0.0;
    double friction = 0.0;
    double static_friction = 0.0;
    double restitution = 0.0;
    double push = 0.0;            ///< so far in this step [m]
    Vector3 carried;              ///< where the obstacle would take the particle's old position [m]
    double approach = 0.0;        ///< speed towards the obstacle at the step's begin, relative to it [m/s]
    double force_approach = 0.0;  ///< what the forces of this step added to it [m/s]
  };

  const SpringNetwork& network_;
  const Environment& environment_;
  Scalars thickness_;           ///< of each particle
  std::vector<Index> body_of_;  ///< of each particle
  std::vector<char> pinned_;
  const Points* before_ = nullptr;
  std::vector<Active> active_;
  Index truncated_ = 0;
  Index squeezed_ = 0;
};

}  // namespace sprung
