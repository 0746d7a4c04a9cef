// Contacts between elements of the network.
#pragma once

#include "collision/core/contact.h"
#include "collision/pairs/contact_candidate.h"
#include "collision/surface/collision_surface.h"
#include "collision/surface/surface_topology.h"

#include <vector>

namespace sprung {

/// Appends a contact for each candidate that comes within its reach on the way from `before` to `after` [m], 3 x n, and whose
/// points are as near as the surfaces around them: others, such as a corner beside a face with another face right below it, would
/// push it aside. In the order of the candidates, which note for how long they are too far apart to be looked at.
void append_self_contacts(const CollisionSurface& surface, const SurfaceTopology& features,
                          std::vector<ContactCandidate>& candidates, const Points& before, const Points& after,
                          std::vector<Contact>& contacts);

}  // namespace sprung
