// Contacts between elements of the network, and the candidates for them.
#pragma once

#include "collision/core/contact.h"
#include "collision/pairs/contact_stencil.h"
#include "collision/surface/collision_surface.h"
#include "collision/surface/surface_topology.h"

#include <array>
#include <vector>

namespace sprung {

/// A vertex and a face, or two edges, that contact checks in every step.
struct ContactCandidate {
  ContactStencil stencil;           ///< its normal is the direction of the last measured separation
  std::array<Index, 2> elements{};  ///< of the two sides; for a vertex, the element that owns it
  std::array<int, 2> edge{};        ///< of an edge-edge stencil: each edge's number in its element
  double gap = 0.0;                 ///< that contact keeps between the sides [m]
  double reach = 0.0;               ///< distance below which contact checks the sides [m]
  int skip_steps = 0;               ///< steps that may skip the candidate, because its sides are far apart
};

template <Same<ContactCandidate> S, class Visit>
void visit_members(S& c, const Visit& visit) {
  visit(c.stencil, c.elements, c.edge, c.gap, c.reach, c.skip_steps);
}

/// Appends a contact for each candidate that comes within its reach between `before` and `after` [m], 3 x n, and whose closest
/// points face each other. A vertex beside a face, with another face right below it, makes none: it would be pushed aside. Contacts
/// have the order of their candidates. Candidates that are far apart note how many steps may skip them.
void append_self_contacts(const CollisionSurface& surface, const SurfaceTopology& features,
                          std::vector<ContactCandidate>& candidates, const Points& before, const Points& after,
                          std::vector<Contact>& contacts);

}  // namespace sprung
