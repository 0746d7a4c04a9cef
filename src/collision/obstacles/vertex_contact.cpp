#include "collision/obstacles/vertex_contact.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

// A surface point is looked for again after a motion of this part of the gap: with older ones friction is no longer the law's, and
// in a crease, where it moves away from the triangle that was nearest and towards another, a particle sinks into the gap by twice
// as much.
constexpr double kSame = 0.02;

/// Where a path meets a shape, in the shape's frame.
struct LocalContact {
  Vector3 point;
  Vector3 normal;
};

LocalContact at(const Crossing& crossing) { return {crossing.point, crossing.normal}; }
LocalContact at(const SurfacePoint& surface) { return {surface.point, surface.normal}; }

/// A path shorter than the distance of its end from the surface cannot have crossed it, so that a particle at rest costs one walk
/// through the tree.
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
std::optional<Contact> find_with(const ObstacleSet& set, Index k, const VertexPath& path, const Nearest& nearest) {
  const double clearance = set.clearance(k, path.before, path.after);
  const double gap = std::max(path.thickness + set.obstacle(k).material.thickness, clearance);
  const LocalPath local = set.local_path(k, path.before, path.after);
  const auto found =
      find_local(set.shape(k), local, gap + path.margin, [&](const Vector3& p, double reach) { return nearest(p, reach, gap); });
  if (!found) return std::nullopt;
  Contact contact = particle_contact(path.particle, k, set.after(k) * found->point, set.after(k).linear() * found->normal);
  contact.drift = set.after(k).linear() * local.shift;
  contact.distance = contact.normal.dot(path.after - contact.point);
  contact.clearance = clearance;
  return contact;
}

}  // namespace

std::optional<Contact> find_contact(const ObstacleSet& set, Index k, const VertexPath& path) {
  return find_with(set, k, path, [&](const Vector3& p, double reach, double) { return set.shape(k).nearest(p, reach); });
}

std::optional<Contact> find_contact(const ObstacleSet& set, Index k, const VertexPath& path, SurfaceMemory& memory) {
  return find_with(set, k, path, [&](const Vector3& p, double reach, double gap) {
    return set.shape(k).nearest_cached(p, reach, kSame * gap, memory);
  });
}

}  // namespace sprung
