#include "dynamics/attachments/engagement.h"

#include "collision/shapes/obstacle_shape.h"
#include "collision/shapes/surface_anchor.h"
#include "dynamics/attachments/link_ends.h"
#include "geometry/queries/closest_pair.h"
#include "network/model/activity.h"

#include <algorithm>
#include <limits>
#include <span>

namespace sprung {
namespace {

// Ends that are nearer than this fraction of the mean spring length coincide: the direction between them is rounding.
constexpr double kCoincident = 1.0e-6;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Finds the point of a body that is nearest to the first end of a link.
class NearestEnd {
 public:
  NearestEnd(const SpringNetwork& network, const Points& positions, Link& link)
      : network_(network), positions_(positions), point_(positions.col(link.first)), link_(link) {}

  void operator()(const ObstacleEnd& /*end*/) {}

  void operator()(const ParticleEnds& ends) {
    for (const Index particle : ends.particles) consider(particle);
  }

  void operator()(const SurfaceEnd& end) {
    const Body& body = network_.bodies[static_cast<std::size_t>(end.body)];
    const Index begin = body.first_particle;
    for (const auto& corners : body.surface.triangles.colwise()) {
      const std::array<Index, 3> particles{begin + corners[0], begin + corners[1], begin + corners[2]};
      const Vector3 a = positions_.col(particles[0]);
      const Vector3 b = positions_.col(particles[1]);
      const Vector3 c = positions_.col(particles[2]);
      const ClosestPoint closest = closest_point_on_triangle(point_, a, b, c);
      if (closest.squared_distance < nearest_) consider(particles, barycentric(closest, a, b, c), closest.point);
    }
    for (const auto& ends : body.surface.segments.colwise()) {
      const Vector3 a = positions_.col(begin + ends[0]);
      const Vector3 b = positions_.col(begin + ends[1]);
      const double t = closest_points_of_segments(point_, point_, a, b).t;
      consider({begin + ends[0], begin + ends[1], kNone}, {1.0 - t, t, 0.0}, a + t * (b - a));
    }
    if (body.surface.triangles.cols() > 0 || body.surface.segments.cols() > 0) return;
    for (Index i = begin; i < begin + body.contact_vertex_count(); ++i) consider(i);
  }

 private:
  void consider(Index particle) { consider({particle, kNone, kNone}, Vector3::UnitX(), positions_.col(particle)); }

  void consider(const std::array<Index, 3>& particles, const Vector3& weights, const Vector3& end) {
    const double squared_distance = (end - point_).squaredNorm();
    if (!(squared_distance < nearest_)) return;
    nearest_ = squared_distance;
    link_.second = particles;
    link_.weights = weights;
  }

  const SpringNetwork& network_;
  const Points& positions_;
  Vector3 point_;
  Link& link_;
  double nearest_ = kInfinity;  ///< squared distance so far [m^2]
};

/// Sets the second end of a link to the point of an obstacle that is nearest to `point` [m] at a time [s].
void put_on(const ObstacleSet& obstacles, const ObstacleEnd& end, const Vector3& point, double time, Link& link) {
  const Obstacle& obstacle = obstacles.obstacle(end.obstacle);
  const Vector3 local = obstacle.motion.pose(obstacle.rest_pose, time).inverse() * point;
  if (obstacle.deforms()) {
    const MeshSequence& sequence = *std::get<SequenceGeometry>(obstacle.geometry).sequence;
    link.triangle = nearest_triangles(sequence, time, {local}).front();
    link.weights = anchored(sequence, link.triangle, time, local).weights;
  } else {
    const auto nearest = obstacles.shape(end.obstacle).nearest(local, kInfinity);
    link.anchor = nearest ? nearest->point : local;
  }
}

/// kNone for an attachment to a body.
Index obstacle_of(const Attachment& attachment) {
  const auto* end = std::get_if<ObstacleEnd>(&attachment.second);
  return end != nullptr ? end->obstacle : kNone;
}

}  // namespace

Link link_to_body(const SpringNetwork& network, const Points& positions, std::size_t attachment, Index particle) {
  Link link{.attachment = attachment, .first = particle};
  std::visit(NearestEnd(network, positions, link), network.attachments[attachment].second);
  return link;
}

bool update_links(const SpringNetwork& network, const ObstacleSet& obstacles, double step_length, SimulationState& state) {
  const double due = due_before(whole_steps(state), step_length);
  const double now = steps_done(state) * step_length;
  const bool ended = std::erase_if(state.links, [&](const Link& link) {
                       return !link.broken && !network.attachments[link.attachment].holds_at(due);
                     }) > 0;
  std::vector<Link> added;
  for (std::size_t a = 0; a < network.attachments.size(); ++a) {
    const Attachment& attachment = network.attachments[a];
    const std::span<const Link> known(std::ranges::lower_bound(state.links, a, {}, &Link::attachment),
                                      std::ranges::upper_bound(state.links, a, {}, &Link::attachment));
    if (known.size() == attachment.particles.size() || !attachment.holds_at(due)) continue;
    const double coincident = kCoincident * mean_spring_length(network);
    for (const Index particle : attachment.particles) {
      if (std::ranges::find(known, particle, &Link::first) != known.end()) continue;
      Link& link = added.emplace_back(link_to_body(network, state.x, a, particle));
      link.time = now;
      if (const auto* end = std::get_if<ObstacleEnd>(&attachment.second)) {
        put_on(obstacles, *end, state.x.col(particle), now, link);
      }
      const LinkEnds ends(network, obstacles.obstacles(), link);
      link.distance = (ends.sum(state.x) - ends.anchor(now)).norm();
      if (link.distance < coincident) link.distance = 0.0;
      link.length = attachment.rest_length.value_or(link.distance);
    }
  }
  if (added.empty()) return ended;
  state.links.insert(state.links.end(), added.begin(), added.end());
  std::ranges::stable_sort(state.links, {}, &Link::attachment);
  return true;
}

void drop_unknown_links(const SpringNetwork& before, const SpringNetwork& network, SimulationState& state) {
  std::erase_if(state.links, [&](const Link& link) {
    if (link.attachment >= network.attachments.size()) return true;
    const Attachment& attachment = network.attachments[link.attachment];
    return std::ranges::find(attachment.particles, link.first) == attachment.particles.end() ||
           obstacle_of(attachment) != obstacle_of(before.attachments[link.attachment]);
  });
}

}  // namespace sprung
