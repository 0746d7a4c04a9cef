// Candidates of contact between elements.
#pragma once

#include "collision/pairs/contact_stencil.h"

#include <array>

namespace sprung {

/// A vertex and a face, or two edges, that contact checks in every step.
struct ContactCandidate {
  ContactStencil stencil;           ///< its normal is the direction of the last measured separation
  std::array<Index, 2> elements{};  ///< of the two sides; for a vertex, the element that owns it
  std::array<int, 2> edge{};        ///< of an edge-edge stencil: each edge's number in its element
  double gap = 0.0;                 ///< that contact keeps between the sides [m]
  double reach = 0.0;               ///< distance below which contact checks the sides [m]
  int rest = 0;                     ///< steps that may skip the candidate, because its sides are far apart
};

}  // namespace sprung
