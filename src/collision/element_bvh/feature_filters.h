// Feature filters: vertices that may come near faces, and edges that may come near each other.
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

/// Eight edges in single precision, a lane each.
struct alignas(64) EdgeLanes {
  Float8 now[2][3];  ///< positions now, by end and axis [m]
  Float8 end[2][3];  ///< positions at the end of the interval [m]
  Float8 radius;     ///< of the larger sphere of its particles, plus a bound of rounding [m]
  ElementBvhLeaf::IntLanes particle[2];
  ElementBvhLeaf::IntLanes marked;  ///< -1 if one of its particles is marked, else 0
  ElementBvhLeaf::IntLanes used;    ///< -1 if the lane has an edge, else 0
};

/// One edge, its positions now and at the end of the interval [m], and its search distance.
struct MovingEdge {
  float now[2][3]{};
  float end[2][3]{};
  Index particle[2]{kNone, kNone};
  bool marked = false;
  float reach = 0.0F;   ///< gap between spheres up to which other edges are found [m]
  float radius = 0.0F;  ///< of its larger sphere, > 0 [m]
};

/// The edge in one lane.
[[nodiscard]] MovingEdge moving_edge(const EdgeLanes& lanes, int lane, float reach);

/// Sets `hits` to the lanes whose edges may come within reach while particles are in their spheres: no coordinate axis, and not the
/// line between the closest points of now, separates the two by more than the reach both now and at the end. Edges that share a
/// particle and pairs of unmarked edges are left out. A conservative filter in single precision. Returns whether there are any.
bool find_edges(const MovingEdge& edge, const EdgeLanes& lanes, LaneBytes& hits);

}  // namespace sprung
