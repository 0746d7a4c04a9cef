// Elements that may touch each other.
#pragma once

#include "collision/element_bvh/element_bvh_leaf.h"

#include <vector>

namespace sprung {

struct ElementIndexPair {
  Index first = kNone;
  Index second = kNone;
};

/// A leaf and where its corners are.
struct BoundedLeaf {
  const ElementBvhLeaf& leaf;
  const LeafBounds& places;
};

/// Appends the pairs of the leaves' elements, at least one of them marked, that may touch from now to the end: those that no plane
/// across the line between their middles, or along one of them, keeps apart. Triangles that share a particle whose triangles are
/// flat are left out.
void append_meetings(const BoundedLeaf& a, const BoundedLeaf& b, HorizonTimes times, std::vector<ElementIndexPair>& meetings);

}  // namespace sprung
