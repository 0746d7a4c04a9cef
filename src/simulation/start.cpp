#include "simulation/start.h"

#include "dynamics/contact_surface.h"
#include "simulation/start_check.h"

namespace sprung {

void refuse_intersections(const SpringNetwork& network, const Environment& environment, const ContactSettings& contact,
                          const Points& positions) {
  const CollisionSurface surface = contact_surface(network);
  StartIntersections found = find_start_intersections(environment, surface, positions);
  if (contact.response == ContactSettings::Response::penalty) found.with_each_other.clear();
  if (found.empty()) return;
  throw InputError(start_problems(found, network, environment, surface, positions,
                                  "move one of them by \"place\", so that they do not overlap"));
}

}  // namespace sprung
