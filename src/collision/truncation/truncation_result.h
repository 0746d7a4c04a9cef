// What the last word on positions did.
#pragma once

#include "collision/core/contact.h"

#include <vector>

namespace sprung {

struct TruncationResult {
  Index truncated = 0;   ///< particles stopped on their way
  Index infeasible = 0;  ///< particles that found no free place, that pins drag through the network, or whose elements are
                         ///< crossed, and pins of their elements that go through each other
  std::vector<Contact> body_contacts{};  ///< of bodies that stopped each other, where the step begins; none of what went in parts
  std::vector<Index> moved_with_obstacles{};  ///< held particles that went along with an obstacle; some more than once
  bool subdivided = false;                    ///< whether obstacles were taken along in parts of the step
};

}  // namespace sprung
