#include "collision/obstacles/obstacle_frame.h"

#include "collision/core/block_bounds.h"
#include "collision/core/contact.h"

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
std::optional<LocalContact> find_local(const ObstacleShape& shape, const LocalPath& path, double reach, double tolerance,
                                       SurfaceMemory* memory) {
  const auto nearest = [&] {
    return memory == nullptr ? shape.nearest(path.end, reach) : shape.nearest_cached(path.end, reach, tolerance, *memory);
  };
  const double length = (path.end - path.begin).norm();
  const bool surface_first = length <= reach;
  std::optional<SurfacePoint> surface;
  if (surface_first) {
    surface = nearest();
    if (!surface) return std::nullopt;
    if (std::abs(surface->distance) > length + shape.rounding(path.end)) return at(*surface);
  }
  if (const auto crossing = shape.first_crossing(path.begin, path.end)) return at(*crossing);
  if (!surface_first) surface = nearest();
  if (!surface) return std::nullopt;
  return at(*surface);
}

double largest(const Vector3& p) { return p.cwiseAbs().maxCoeff(); }

}  // namespace

std::optional<Contact> find_contact(const ObstacleFrame& frame, Index k, const VertexPath& path, SurfaceMemory* memory) {
  const double clearance = frame.clearance(k, path.before, path.after);
  const double gap = std::max(path.thickness + frame.obstacle(k).material.thickness, clearance);
  const LocalPath local = frame.local_path(k, path.before, path.after);
  const auto found = find_local(frame.shape(k), local, gap + path.margin, kReuseFraction * gap, memory);
  if (!found) return std::nullopt;
  Contact contact = particle_contact(path.particle, k, frame.after(k) * found->point, frame.after(k).linear() * found->normal);
  contact.drift = frame.after(k).linear() * local.shift;
  contact.distance = contact.normal.dot(path.after - contact.point);
  contact.clearance = clearance;
  return contact;
}

ObstacleFrame::ObstacleFrame(const ObstacleSet& set, double begin, double end)
    : set_(&set), begin_(begin), end_(end), posed_(set.posed(begin, end)) {}

void ObstacleFrame::find_near(const Box3& box, std::vector<Index>& found) const {
  set_->broad_phase_->find_near(box, posed_->changing, found);
}

double ObstacleFrame::clearance(Index k, const Vector3& from, const Vector3& to) const {
  return kClearance * std::max({posed(k).magnitude, largest(from), largest(to)});
}

double ObstacleFrame::max_clearance(const Box3& box) const {
  return kClearance * std::max({posed_->max_magnitude, largest(box.min()), largest(box.max())});
}

Vector3 ObstacleFrame::moved_position(Index k, const Vector3& from) const {
  if (is_at_rest(k)) return from;
  const Vector3 before = local_before(k, from);
  const auto moved = shape(k).moved_element({.x = {before}, .count = 1});
  return after(k) * (moved ? moved->corners.x[0] : Vector3(before + shape(k).displacement(before)));
}

double ObstacleFrame::max_displacement(const Points& positions) const {
  if (posed_->changing.empty()) return 0.0;
  const Box3 box = finite_bounds(positions, 0, static_cast<Index>(positions.cols()));
  if (box.isEmpty()) return 0.0;
  double farthest = 0.0;
  for (const ObstacleBound& changing : posed_->changing) {
    const Index k = changing.obstacle;
    const RigidTransform motion = after(k) * into_before(k);
    const double at_centre = (motion * box.center() - box.center()).norm();
    const double around = (motion.linear() - Matrix3::Identity()).norm() * 0.5 * box.diagonal().norm();
    farthest = std::max(farthest, at_centre + around + shape(k).largest_displacement());
  }
  return farthest;
}

Vector3 ObstacleFrame::surface_velocity(Index k, const Vector3& position, double time, double dt) const {
  const auto& [name, geometry, rest_pose, motion, material] = obstacle(k);
  const bool deforms = shape(k).deforms();
  if (!motion.moves() && !deforms) return Vector3::Zero();
  const Vector3 moved = motion.pose(rest_pose, time + dt) * (motion.pose(rest_pose, time).inverse() * position);
  Vector3 drift = Vector3::Zero();
  if (deforms) drift = after(k).linear() * shape(k).displacement(local(k, position), time, time + dt);
  return (moved - position + drift) / dt;
}

std::vector<Contact> ObstacleFrame::contacts(const VertexPaths& paths) const {
  const auto count = static_cast<Index>(paths.after.cols());
  if (set_->empty()) return {};
  const double displacement = max_displacement(paths.before);

  return collect_from_blocks<Contact>(count, [&](Index begin, Index end, std::vector<Contact>& contacts) {
    const Box3 box = finite_bounds(paths.before, begin, end).merged(finite_bounds(paths.after, begin, end));
    if (box.isEmpty()) return;
    const double gap = paths.thickness.segment(begin, end - begin).maxCoeff() + set_->max_thickness();
    const double reach = std::max(gap, max_clearance(box)) + paths.margin;
    std::vector<Index> near;
    find_near(grown(box, reach + displacement), near);
    if (near.empty()) return;
    for (Index i = begin; i < end; ++i) {
      const Vector3 before = paths.before.col(i);
      const Vector3 after = paths.after.col(i);
      if (!before.allFinite() || !after.allFinite()) continue;
      for (const Index k : near) {
        const auto contact = find_contact(*this, k, {i, before, after, paths.thickness[i], paths.margin});
        if (contact) contacts.push_back(*contact);
      }
    }
  });
}

std::optional<double> ObstacleFrame::min_distance(const Points& positions, double radius) const {
  const std::vector<double> distances =
      collect_from_blocks<double>(static_cast<Index>(positions.cols()), [&](Index begin, Index end, std::vector<double>& found) {
        const Box3 box = finite_bounds(positions, begin, end);
        if (box.isEmpty()) return;
        std::vector<Index> near;
        find_near(grown(box, radius), near);
        double smallest = radius;
        for (Index i = begin; i < end; ++i) {
          for (const Index k : near) {
            const Vector3 p = local(k, positions.col(i));
            if (!p.allFinite()) continue;
            if (const auto surface = shape(k).nearest(p, smallest)) smallest = std::min(smallest, surface->distance);
          }
        }
        if (smallest < radius) found.push_back(smallest);
      });
  if (distances.empty()) return std::nullopt;
  return *std::min_element(distances.begin(), distances.end());
}

}  // namespace sprung
