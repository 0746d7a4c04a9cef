#include "dynamics/attachments/link_ends.h"

#include <numeric>

namespace sprung {

LinkEnds::LinkEnds(const SpringNetwork& network, const std::vector<Obstacle>& obstacles, const Link& link)
    : surface_{link.triangle, link.weights, Vector3::Zero()}, local_(link.anchor) {
  const auto add = [&](Index particle, double weight) {
    particles_[count_] = particle;
    weights_[count_++] = weight;
  };
  add(link.first, 1.0);
  if (const auto* end = std::get_if<ObstacleEnd>(&network.attachments[link.attachment].second)) {
    obstacle_ = &obstacles[static_cast<std::size_t>(end->obstacle)];
    return;
  }
  for (std::size_t k = 0; k < link.second.size(); ++k) {
    if (link.second[k] != kNone) add(link.second[k], -link.weights[static_cast<Eigen::Index>(k)]);
  }
}

Vector3 LinkEnds::sum(const Points& columns) const {
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < count_; ++k) sum += weights_[k] * columns.col(particles_[k]);
  return sum;
}

Vector3 LinkEnds::anchor(double time) const {
  if (obstacle_ == nullptr) return Vector3::Zero();
  const RigidTransform pose = obstacle_->motion.pose(obstacle_->rest_pose, time);
  if (!obstacle_->deforms()) return pose * local_;
  return pose * anchored_position(*std::get<SequenceGeometry>(obstacle_->geometry).sequence, surface_, time);
}

double LinkEnds::inverse_mass(const Scalars& inverse_masses) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < count_; ++k) sum += weights_[k] * weights_[k] * inverse_masses[particles_[k]];
  return sum;
}

double mean_spring_length(const SpringNetwork& network) {
  const std::vector<double>& lengths = network.springs.rest_length;
  const double sum = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  return sum > 0.0 ? sum / static_cast<double>(lengths.size()) : 1.0;
}

}  // namespace sprung
