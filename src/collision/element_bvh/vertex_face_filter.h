// Corners that come before faces.
#pragma once

#include "collision/element_bvh/element_bvh_leaf.h"

namespace sprung {

/// A corner on its way from now to the end [m], and how near it is looked for.
struct MovingVertex {
  float now[3]{};
  float end[3]{};
  Index particle = kNone;
  float reach = 0.0F;  ///< from a face, along its normal
  float aside = 0.0F;  ///< beside it, > 0
};

/// Finds the leaf's triangles that the corner, which is none of theirs, comes within reach of, and does not miss by more than
/// `aside` and what the way leads along the triangle. In single precision, for a choice of what to look at. Returns whether there
/// are any.
bool find_faces(const MovingVertex& corner, const ElementBvhLeaf& leaf, const LeafBounds& places, LaneBytes& met);

}  // namespace sprung
