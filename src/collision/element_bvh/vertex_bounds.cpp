#include "collision/element_bvh/vertex_bounds.h"

#include <algorithm>
#include <array>

namespace sprung {
namespace {

// Fans with more spokes are rare and never count as flat.
constexpr std::size_t kMostSpokes = 16;

/// The fan's spokes as vectors from its center, now and at the horizon.
struct Fan {
  std::array<Vector3, kMostSpokes + 1> begin;
  std::array<Vector3, kMostSpokes + 1> end;
  std::array<double, kMostSpokes + 1> length;  ///< of each spoke, the largest in between
  std::size_t spokes = 0;
  std::size_t faces = 0;
  double radius = 0.0;  ///< of the largest sphere
};

/// A closed fan repeats its first spoke after the last.
Fan gather(const SurfaceTopology& features, Index particle, const VertexBounds& spheres, double horizon) {
  Fan fan;
  const auto spokes = features.spokes(particle);
  const bool closed = features.fan(particle) == FanKind::closed;
  fan.spokes = spokes.size() + (closed ? 1 : 0);
  fan.faces = fan.spokes - 1;
  fan.radius = spheres.radius(particle);
  for (std::size_t k = 0; k < fan.spokes; ++k) {
    const Index other = spokes[k < spokes.size() ? k : 0];
    fan.begin[k] = spheres.center(other) - spheres.center(particle);
    fan.end[k] = fan.begin[k] + horizon * (spheres.motion(other) - spheres.motion(particle));
    fan.length[k] = std::sqrt(std::max(fan.begin[k].squaredNorm(), fan.end[k].squaredNorm()));
    fan.radius = std::max(fan.radius, spheres.radius(other));
  }
  return fan;
}

/// Twice the area of each triangle, projected along `eye`, is a quadratic function of time, bounded below by its smallest Bernstein
/// coefficient. Moving each corner by the radius reduces it by at most radius x perimeter + 3 radius^2.
bool faces_stay_turned(const Fan& fan, const Vector3& eye) {
  for (std::size_t k = 0; k < fan.faces; ++k) {
    const Vector3& a0 = fan.begin[k];
    const Vector3& b0 = fan.begin[k + 1];
    const Vector3& a1 = fan.end[k];
    const Vector3& b1 = fan.end[k + 1];
    const double at_begin = eye.dot(a0.cross(b0));
    const double at_end = eye.dot(a1.cross(b1));
    const double between = 0.5 * eye.dot(a0.cross(b1) + a1.cross(b0));
    const double rim = std::sqrt(std::max((b0 - a0).squaredNorm(), (b1 - a1).squaredNorm()));
    const double lost = fan.radius * (fan.length[k] + fan.length[k + 1] + rim + 3.0 * fan.radius);
    if (!(std::min({at_begin, at_end, between}) > lost)) return false;
  }
  return true;
}

/// Each triangle spans less than half a turn, so the spokes change from the lower to the upper side once per turn.
bool turns_once(const Fan& fan, const Vector3& eye) {
  int axis = 0;
  eye.cwiseAbs().minCoeff(&axis);
  const Vector3 up = eye.cross(Vector3::Unit(axis));
  int turns = 0;
  for (std::size_t k = 0; k < fan.faces; ++k) turns += up.dot(fan.begin[k]) < 0.0 && up.dot(fan.begin[k + 1]) >= 0.0 ? 1 : 0;
  return turns == 1;
}

/// The first and the last spoke stay on different sides of a line through the center, so that they cannot touch behind it.
bool ends_stay_apart(const Fan& fan, const Vector3& eye) {
  if (fan.faces <= 2) return true;  // each spans less than half a turn
  const std::size_t last = fan.spokes - 1;
  Vector3 side = fan.begin[0].normalized() - fan.begin[last].normalized();
  side -= eye.dot(side) * eye;
  const double lost = 2.0 * fan.radius * side.norm();
  if (!(std::min(side.dot(fan.begin[0]), side.dot(fan.end[0])) > lost)) return false;
  if (!(std::max(side.dot(fan.begin[last]), side.dot(fan.end[last])) < -lost)) return false;
  int changes = 0;
  for (std::size_t k = 0; k < fan.faces; ++k)
    changes += (side.dot(fan.begin[k]) < 0.0) != (side.dot(fan.begin[k + 1]) < 0.0) ? 1 : 0;
  return changes == 1;
}

}  // namespace

bool fan_stays_flat(const SurfaceTopology& features, Index particle, const VertexBounds& spheres, double horizon) {
  const FanKind kind = features.fan(particle);
  if (kind == FanKind::none || features.spokes(particle).size() > kMostSpokes) return false;
  const Fan fan = gather(features, particle, spheres, horizon);
  Vector3 eye = Vector3::Zero();
  for (std::size_t k = 0; k < fan.faces; ++k) eye += fan.begin[k].cross(fan.begin[k + 1]);
  eye.normalize();
  if (!faces_stay_turned(fan, eye)) return false;
  return kind == FanKind::closed ? turns_once(fan, eye) : ends_stay_apart(fan, eye);
}

}  // namespace sprung
