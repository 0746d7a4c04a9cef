// Bodies that cross themselves because self_contact is off.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

struct SelfCrossing {
  Index body = 0;      ///< its number in the network
  Index elements = 0;  ///< number of its faces and segments that cross others of it
};

/// Bodies without self-contact that cross themselves at `positions` [m], 3 x n, finite. Counts crossings in which one element at
/// least is a face; two crossing segments are ignored, as in a rope that swings in a plane. A body that crosses itself at the
/// network's positions (time 0) is left out, because self-contact would refuse it. Exact.
[[nodiscard]] std::vector<SelfCrossing> find_self_crossings(const SpringNetwork& network, const Points& positions);

}  // namespace sprung
