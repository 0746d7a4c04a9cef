// Element-element filter: pairs of elements that may touch.
#pragma once

#include "collision/element_bvh/element_bvh_leaf.h"

#include <vector>

namespace sprung {

struct ElementIndexPair {
  Index first = kNone;
  Index second = kNone;
};

/// A leaf and the positions of its corners.
struct PositionedLeaf {
  const ElementBvhLeaf& leaf;
  const LeafCorners& corners;
};

/// Appends the pairs of the leaves' elements that may touch between now and the end and of which at least one is marked. A pair is
/// left out if a plane separates it: across a coordinate axis, across the line between the centroids or parallel to one of its
/// triangles. Triangles that share a particle whose fan stays flat are left out, too.
void append_pairs(const PositionedLeaf& a, const PositionedLeaf& b, HorizonTimes times, std::vector<ElementIndexPair>& pairs);

}  // namespace sprung
