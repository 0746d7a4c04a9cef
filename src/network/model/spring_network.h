// The network: masses, springs, bodies and pins. Most of what a step changes is in SimulationState.
#pragma once

#include "base/types.h"
#include "network/model/attachment.h"
#include "network/model/body.h"
#include "network/model/face_bends.h"
#include "network/model/pin.h"
#include "network/model/springs.h"

#include <string>
#include <vector>

namespace sprung {

/// The model of a network, from NetworkBuilder. A step of a simulator changes in its own one the rest lengths of springs that
/// yield, springs that break with what goes with them, and pins that begin or end.
struct SpringNetwork {
  Points positions;        ///< at time 0 [m], 3 x n
  Points velocities;       ///< at time 0 [m/s], 3 x n; 0 of pinned particles
  Scalars masses;          ///< [kg], > 0
  Scalars inverse_masses;  ///< [1/kg]; 0 for pinned particles and those that sleep
  Scalars drag_areas;      ///< factor of the air drag: the particle's share in the area [m^2] of its body's faces, plus that
                           ///< in the length [m] of its segments; 1 in a body without either
  Springs springs;
  AngleBends angle_bends;
  Hinges hinges;
  FaceBends face_bends;
  std::vector<Body> bodies;
  std::vector<Pin> pins;                 ///< that hold their particles
  std::vector<Pin> later_pins;           ///< that have not begun
  std::vector<std::string> pin_names{};  ///< of all pins, in the order in which they were added, also of those that have ended
  std::vector<Attachment> attachments{};
  Springs broken{};            ///< that broke and are gone, with those that went with them
  std::vector<char> asleep{};  ///< by particle, see set_asleep(); empty: none sleeps

  [[nodiscard]] Index particle_count() const { return static_cast<Index>(masses.size()); }
  /// Whether the particle is pinned or sleeps.
  [[nodiscard]] bool is_pinned(Index particle) const { return inverse_masses[particle] == 0.0; }
  [[nodiscard]] bool is_asleep(Index particle) const { return !asleep.empty() && asleep[particle] != 0; }
  /// The body of a particle. Requires a particle of the network.
  [[nodiscard]] const Body& body_of(Index particle) const;
};

/// The columns of the particles that are vertices of surfaces for contact, without the cells that carry some of them, 3 x m.
[[nodiscard]] Points contact_positions(const SpringNetwork& network, const Points& positions);

/// Whether a body may collide with itself or with another body.
[[nodiscard]] bool bodies_may_collide(const SpringNetwork& network);

}  // namespace sprung
