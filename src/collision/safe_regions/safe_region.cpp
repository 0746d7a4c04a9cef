#include "collision/safe_regions/safe_region.h"

#include <algorithm>

namespace sprung {

namespace {

constexpr double kStandOff = 0.3;

// Fraction of the clearance. The clearance is 2^-30 of the coordinates, so this is 2^-42 of them.
constexpr double kTouching = 0x1p-12;

}  // namespace

Box3 shrunk(const Box3& box, double margin) { return {box.min().array() + margin, box.max().array() - margin}; }

Box3 box_around(const ElementCorners& element, double reach) {
  Box3 box;
  for (int i = 0; i < element.count; ++i) box.extend(element.x[static_cast<std::size_t>(i)]);
  return {box.min() - Vector3::Constant(reach), box.max() + Vector3::Constant(reach)};
}

Box3 requested_box(const ElementCorners& element, const SafeRegionRequest& request) {
  const Box3 box = box_around(element, 0.0).merged(request.path);
  return {box.min() - Vector3::Constant(request.reach), box.max() + Vector3::Constant(request.reach)};
}

double stand_off(double gap, const SafeRegionRequest& request) {
  return std::min(gap, std::max(request.clearance, std::min(kStandOff * gap, 0.5 * request.gap)));
}

bool is_touching(double gap, const SafeRegionRequest& request) { return !(gap > kTouching * request.clearance); }

}  // namespace sprung
