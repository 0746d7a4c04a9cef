// The network: masses, springs, bodies and pins. Most of what a step changes is in SimulationState.
#pragma once

#include "base/types.h"
#include "network/model/activity.h"
#include "network/model/attachment.h"
#include "network/model/body.h"
#include "network/model/face_bends.h"
#include "network/model/pin.h"
#include "network/model/springs.h"

#include <vector>

namespace sprung {

/// The model of a network, from NetworkBuilder. A simulator derives the network of the present from it and the state: without the
/// springs that broke and what goes with them, with the rest lengths to which springs yielded, and with the present activity.
struct SpringNetwork {
  Points positions;        ///< at time 0 [m], 3 x n
  Points velocities;       ///< at time 0 [m/s], 3 x n; 0 of pinned particles
  Scalars masses;          ///< [kg], > 0
  Scalars inverse_masses;  ///< [1/kg]; 0 for particles that are pinned or sleep: see set_activity()
  Scalars drag_areas;      ///< factor of the air drag: the particle's share in the area [m^2] of its body's faces, plus that
                           ///< in the length [m] of its segments; 1 in a body without either
  Springs springs;
  AngleBends angle_bends;
  Hinges hinges;
  FaceBends face_bends;
  std::vector<Body> bodies;
  std::vector<Pin> pins;  ///< also those that have not begun, or have ended
  std::vector<Attachment> attachments{};
  Activity activity{};  ///< at time 0, or in the present of a simulator

  [[nodiscard]] Index particle_count() const { return static_cast<Index>(masses.size()); }
  /// Whether the particle is pinned or sleeps.
  [[nodiscard]] bool is_fixed(Index particle) const { return inverse_masses[particle] == 0.0; }
  [[nodiscard]] bool is_pinned(Index particle) const { return activity.is_pinned(particle); }
  [[nodiscard]] bool is_asleep(Index particle) const { return activity.is_asleep(particle); }
  /// The body of a particle. Requires a particle of the network.
  [[nodiscard]] const Body& body_of(Index particle) const;
};

/// The columns of the particles that are vertices of surfaces for contact, without the cells that carry some of them, 3 x m.
[[nodiscard]] Points contact_positions(const SpringNetwork& network, const Points& positions);

/// Whether a body of the network has triangles.
[[nodiscard]] bool has_triangles(const SpringNetwork& network);

/// Whether a body has a drag of its own.
[[nodiscard]] bool has_own_drag(const SpringNetwork& network);

/// Whether a body may collide with itself or with another body.
[[nodiscard]] bool bodies_may_collide(const SpringNetwork& network);

}  // namespace sprung
