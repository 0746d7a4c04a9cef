// Vertex-face filter: vertices that may come near faces.
#pragma once

#include "collision/element_bvh/element_bvh_leaf.h"

namespace sprung {

/// A vertex, its positions now and at the end of the interval [m], and its search distances.
struct MovingVertex {
  float now[3]{};
  float end[3]{};
  Index particle = kNone;
  float reach = 0.0F;  ///< along a face's normal [m]
  float aside = 0.0F;  ///< beyond a face's border, > 0 [m]
};

/// Sets `hits` to the leaf's triangles, without those of the vertex, that the vertex may come within reach of, and beyond whose
/// border it is by at most `aside` plus its displacement along the triangle. A conservative filter in single precision. Returns
/// whether there are any.
bool find_faces(const MovingVertex& vertex, const ElementBvhLeaf& leaf, const LeafCorners& corners, LaneBytes& hits);

}  // namespace sprung
