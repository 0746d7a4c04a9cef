#include "collision/mesh_bvh/segment_triangle_crossing.h"

#include "geometry/queries/side_of_plane.h"

namespace sprung {

namespace {

bool changes_side(double begin, double end, CrossingSides sides) {
  if (sides == CrossingSides::front) return (begin >= 0.0 && end < 0.0) || (begin > 0.0 && end == 0.0);
  return (begin > 0.0 && end <= 0.0) || (begin < 0.0 && end >= 0.0);
}

}  // namespace

std::optional<double> crossing_fraction(const Vector3& a, const Vector3& b, const Vector3& u, const Vector3& v, const Vector3& w,
                                        CrossingSides sides) {
  const double begin = side_of_plane(u, v, w, a);
  const double end = side_of_plane(u, v, w, b);
  if (!changes_side(begin, end, sides)) return std::nullopt;
  const double uv = side_of_plane(a, b, u, v);
  const double vw = side_of_plane(a, b, v, w);
  if ((uv > 0.0 && vw < 0.0) || (uv < 0.0 && vw > 0.0)) return std::nullopt;
  const double wu = side_of_plane(a, b, w, u);
  const bool around = (uv >= 0.0 && vw >= 0.0 && wu >= 0.0) || (uv <= 0.0 && vw <= 0.0 && wu <= 0.0);
  if (!around) return std::nullopt;
  return begin / (begin - end);
}

}  // namespace sprung
