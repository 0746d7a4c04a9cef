#include "collision/element_bvh/element_bvh_leaf.h"

#include "base/machine/kernel.h"

#include <cstring>
#include <limits>

namespace sprung {
namespace {

// Bound of the error of sums of products in single precision, relative to the largest coordinate.
constexpr double kRounding = 0x1p-20;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

double magnitude(const Box3& box) { return box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff(); }

}  // namespace

ElementBvhLeaf::ElementBvhLeaf() {
  std::memset(static_cast<void*>(this), 0, sizeof *this);
  for (int axis = 0; axis < 3; ++axis) {
    min[axis] = Float8{} + kInfinity;
    max[axis] = Float8{} - kInfinity;
  }
  element.fill(kNone);
}

void ElementBvhLeaf::set(int lane, Index number, const Element& source, const VertexBounds& spheres, const Vector3& origin,
                         const std::vector<char>& is_flat, HorizonTimes times) {
  element[static_cast<std::size_t>(lane)] = number;
  is_triangle[lane] = source.corners == 3 ? -1 : 0;
  Box3 box;
  Box3 speeds;
  double largest = 0.0;
  for (int k = 0; k < 3; ++k) {
    const Index i = source.particles[k < source.corners ? static_cast<std::size_t>(k) : 0];
    const Vector3 start = spheres.center(i, -times.now) - origin;
    const Vector3 speed = spheres.motion(i);
    box.extend(start);
    speeds.extend(speed);
    largest = std::max(largest, spheres.radius(i));
    particle[k][lane] = i;
    flat[k][lane] = source.corners == 3 && is_flat[static_cast<std::size_t>(i)] != 0 ? -1 : 0;
    for (int axis = 0; axis < 3; ++axis) {
      corner[k][axis][lane] = static_cast<float>(start[axis]);
      motion[k][axis][lane] = static_cast<float>(speed[axis]);
    }
  }
  const double safe_radius = largest + kRounding * (magnitude(box) + times.end * magnitude(speeds));
  for (int axis = 0; axis < 3; ++axis) {
    min[axis][lane] = static_cast<float>(box.min()[axis] - safe_radius);
    max[axis][lane] = static_cast<float>(box.max()[axis] + safe_radius);
    slowest[axis][lane] = static_cast<float>(speeds.min()[axis]);
    fastest[axis][lane] = static_cast<float>(speeds.max()[axis]);
  }
  radius[lane] = static_cast<float>(safe_radius);
}

void ElementBvhLeaf::bound() {
  bounds = lane_bounds(0);
  for (int lane = 1; lane < count; ++lane) extend(bounds, lane_bounds(lane));
}

void ElementBvhLeaf::bound_marked() {
  bool first = true;
  for (int lane = 0; lane < count; ++lane) {
    if (marked[lane] == 0) continue;
    if (first) {
      marked_bounds = lane_bounds(lane);
    } else {
      extend(marked_bounds, lane_bounds(lane));
    }
    first = false;
  }
}

SPRUNG_KERNEL void find_corners(const ElementBvhLeaf& leaf, HorizonTimes times, LeafCorners& corners) {
  const auto now = static_cast<float>(times.now);
  const auto end = static_cast<float>(times.end);
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      corners.now[k][axis] = leaf.corner[k][axis] + now * leaf.motion[k][axis];
      corners.end[k][axis] = leaf.corner[k][axis] + end * leaf.motion[k][axis];
    }
  }
}

SPRUNG_KERNEL void find_lanes_near(const ElementBvhLeaf& leaf, const KineticAabb& bounds, HorizonTimes times, float margin,
                                   LaneBytes& near) {
  const auto now = static_cast<float>(times.now);
  const auto end = static_cast<float>(times.end);
  ElementBvhLeaf::IntLanes apart = {};
  for (int axis = 0; axis < 3; ++axis) {
    const Float8 above = leaf.min[axis] - bounds.max[axis];
    const Float8 rising = leaf.slowest[axis] - bounds.fastest[axis];
    const Float8 below = bounds.min[axis] - leaf.max[axis];
    const Float8 falling = bounds.slowest[axis] - leaf.fastest[axis];
    apart |= (above + now * rising > margin) & (above + end * rising > margin);
    apart |= (below + now * falling > margin) & (below + end * falling > margin);
  }
  store(~apart, near);
}

bool ElementBvhLeaf::any_marked() const {
  LaneBytes mask;
  store(marked, mask);
  return any(mask);
}

}  // namespace sprung
