// Where two parts of the network would meet.
#pragma once

#include "collision/core/contact.h"
#include "collision/pairs/convex_pair.h"

#include <optional>

namespace sprung {

/// The nearest points of a pair's sides at `positions` [m], 3 x n, as a contact along the line between them, and how far apart they
/// are there; none where they touch or cross, or next to it, or
/// where more than four corners have a part of them.
[[nodiscard]] std::optional<Contact> meeting_of(const ConvexPair& pair, const Points& positions);

}  // namespace sprung
