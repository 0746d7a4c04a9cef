// Contacts between elements of the network.
#pragma once

#include "collision/core/contact.h"
#include "collision/pairs/contact_candidate.h"
#include "collision/surface/collision_surface.h"
#include "collision/surface/surface_topology.h"

#include <vector>

namespace sprung {

/// Appends a contact for each candidate that comes within its reach between `before` and `after` [m], 3 x n, and whose closest
/// points face each other. A vertex beside a face, with another face right below it, makes none: it would be pushed aside. Contacts
/// have the order of their candidates. Candidates that are far apart note how many steps may skip them.
void append_self_contacts(const CollisionSurface& surface, const SurfaceTopology& features,
                          std::vector<ContactCandidate>& candidates, const Points& before, const Points& after,
                          std::vector<Contact>& contacts);

}  // namespace sprung
