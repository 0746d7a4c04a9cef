// Bodies that pass through themselves because self_contact is off.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

struct SelfCrossing {
  Index body = 0;      ///< its number in the network
  Index elements = 0;  ///< number of its faces and segments that cross others of it
};

/// The bodies without self-contact whose faces are crossed by others of their faces or segments at `positions` [m], 3 x n, which
/// must be finite. Without those whose shape crosses itself at the network's positions, those of time 0: self-contact would refuse
/// it. Decided exactly. Two segments are lines that pass each other, as those of a rope that swings in a plane.
[[nodiscard]] std::vector<SelfCrossing> find_self_crossings(const SpringNetwork& network, const Points& positions);

}  // namespace sprung
