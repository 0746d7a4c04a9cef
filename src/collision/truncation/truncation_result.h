// What truncation reports of a step.
#pragma once

#include "collision/core/contact.h"

#include <vector>

namespace sprung {

struct TruncationResult {
  Index truncated = 0;   ///< particles that did not reach their target
  Index infeasible = 0;  ///< particles without an admissible position, corners of crossed elements, and particles, fixed ones too,
                         ///< that pins pull through other elements
  std::vector<Contact> body_contacts{};  ///< between bodies that stopped each other, at the begin of the step; none if subdivided
  std::vector<Index> moved_with_obstacles{};  ///< particles between elements that moved with an obstacle; may repeat
  bool subdivided = false;                    ///< whether the step was subdivided
};

}  // namespace sprung
