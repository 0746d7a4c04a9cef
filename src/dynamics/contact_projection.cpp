#include "dynamics/contact_projection.h"

#include "dynamics/contact_pair.h"

#include <algorithm>

namespace sprung {
namespace {

// Contacts are looked for this part of the thickness beyond the gap: the passes of a step move resting particles less.
constexpr double kMargin = 0.5;

double largest_thickness(const std::vector<Obstacle>& obstacles) {
  double largest = 0.0;
  for (const Obstacle& obstacle : obstacles) largest = std::max(largest, obstacle.material.thickness);
  return largest;
}

}  // namespace

ContactProjection::ContactProjection(const SpringNetwork& network, const Environment& environment)
    : environment_(environment),
      response_(network, environment),
      thickness_(particle_thickness(network)),
      margin_(kMargin * (thickness_.maxCoeff() + largest_thickness(environment.obstacles()))),
      pinned_(static_cast<std::size_t>(network.particle_count())) {
  for (Index i = 0; i < network.particle_count(); ++i) pinned_[static_cast<std::size_t>(i)] = network.is_pinned(i) ? 1 : 0;
}

void ContactProjection::find(const StepMotion& motion) {
  response_.start(environment_.contacts({motion.before, motion.advanced, thickness_, margin_}), motion);
}

void ContactProjection::truncate(const Points& before, Points& positions) {
  squeezed_ = 0;
  truncated_ = static_cast<Index>(environment_.truncate(before, positions, pinned_, squeezed_).size());
}

}  // namespace sprung
