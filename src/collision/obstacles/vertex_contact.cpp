#include "collision/obstacles/vertex_contact.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

// A surface point is reused until the particle has moved by this fraction of the gap. Older points make friction inaccurate. In a
// crease a particle moves away from the nearest triangle towards another one, and would then sink twice as deep into the gap.
constexpr double kReuseFraction = 0.02;

/// A contact in the frame of the shape.
struct LocalContact {
  Vector3 point;
  Vector3 normal;
};

LocalContact at(const Crossing& crossing) { return {crossing.point, crossing.normal}; }
LocalContact at(const SurfacePoint& surface) { return {surface.point, surface.normal}; }

/// A path shorter than the distance between its end and the surface cannot cross the surface. A particle at rest therefore needs
/// only one search in the tree.
template <class Nearest>
std::optional<LocalContact> find_local(const ObstacleShape& shape, const LocalPath& path, double reach, const Nearest& nearest) {
  const double length = (path.end - path.begin).norm();
  const bool surface_first = length <= reach;
  std::optional<SurfacePoint> surface;
  if (surface_first) {
    surface = nearest(path.end, reach);
    if (!surface) return std::nullopt;
    if (std::abs(surface->distance) > length + shape.rounding(path.end)) return at(*surface);
  }
  if (const auto crossing = shape.first_crossing(path.begin, path.end)) return at(*crossing);
  if (!surface_first) surface = nearest(path.end, reach);
  if (!surface) return std::nullopt;
  return at(*surface);
}

template <class Nearest>
std::optional<Contact> find_with(const ObstacleFrame& frame, Index k, const VertexPath& path, const Nearest& nearest) {
  const double clearance = frame.clearance(k, path.before, path.after);
  const double gap = std::max(path.thickness + frame.obstacle(k).material.thickness, clearance);
  const LocalPath local = frame.local_path(k, path.before, path.after);
  const auto found =
      find_local(frame.shape(k), local, gap + path.margin, [&](const Vector3& p, double reach) { return nearest(p, reach, gap); });
  if (!found) return std::nullopt;
  Contact contact = particle_contact(path.particle, k, frame.after(k) * found->point, frame.after(k).linear() * found->normal);
  contact.drift = frame.after(k).linear() * local.shift;
  contact.distance = contact.normal.dot(path.after - contact.point);
  contact.clearance = clearance;
  return contact;
}

}  // namespace

std::optional<Contact> find_contact(const ObstacleFrame& frame, Index k, const VertexPath& path) {
  return find_with(frame, k, path, [&](const Vector3& p, double reach, double) { return frame.shape(k).nearest(p, reach); });
}

std::optional<Contact> find_contact(const ObstacleFrame& frame, Index k, const VertexPath& path, SurfaceMemory& memory) {
  return find_with(frame, k, path, [&](const Vector3& p, double reach, double gap) {
    return frame.shape(k).nearest_cached(p, reach, kReuseFraction * gap, memory);
  });
}

}  // namespace sprung
