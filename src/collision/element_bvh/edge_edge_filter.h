// Edges that come near each other.
#pragma once

#include "collision/element_bvh/element_bvh_leaf.h"

namespace sprung {

/// Eight edges side by side, in single precision; unused lanes are not `used`.
struct alignas(64) EdgeLanes {
  Float8 now[2][3];  ///< by end and axis [m]
  Float8 end[2][3];
  Float8 radius;  ///< of the larger ball of its particles, and what rounding may lose [m]
  ElementBvhLeaf::IntLanes particle[2];
  ElementBvhLeaf::IntLanes marked;  ///< -1 or 0: one of its particles is
  ElementBvhLeaf::IntLanes used;    ///< -1 or 0
};

/// An edge on its way from now to the end [m], and how near others are looked for.
struct MovingEdge {
  float now[2][3]{};
  float end[2][3]{};
  Index particle[2]{kNone, kNone};
  bool marked = false;
  float reach = 0.0F;   ///< between balls [m]
  float radius = 0.0F;  ///< of its own, > 0 [m]
};

/// The lane of `lanes` on its own.
[[nodiscard]] MovingEdge edge_way(const EdgeLanes& lanes, int lane, float reach);

/// Finds the edges that the edge, which shares no particle with them, may come within reach of while particles are in their balls:
/// those that are not farther apart, now and at the end, along an axis or along the line between the points that are nearest now.
/// One of both is marked. In single precision, for a choice of what to look at. Returns whether there are any.
bool find_edges(const MovingEdge& edge, const EdgeLanes& lanes, LaneBytes& met);

}  // namespace sprung
