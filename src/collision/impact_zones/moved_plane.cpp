#include "collision/impact_zones/moved_plane.h"

namespace sprung {

namespace {

Matrix3 cofactors(const Matrix3& m) {
  Matrix3 result;
  result << m.col(1).cross(m.col(2)), m.col(2).cross(m.col(0)), m.col(0).cross(m.col(1));
  return result;
}

}  // namespace

MovedPlane moved_plane(const Vector3& normal, const Matrix3& linear) {
  const Matrix3 at_end = cofactors(linear);
  const Matrix3 midway = 0.5 * (cofactors(Matrix3::Identity() + linear) - Matrix3::Identity() - at_end);
  return {normal, midway * normal, at_end * normal};
}

}  // namespace sprung
