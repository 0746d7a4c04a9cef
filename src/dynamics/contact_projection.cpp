#include "dynamics/contact_projection.h"

#include "dynamics/contact_pair.h"
#include "dynamics/contact_surface.h"

#include <algorithm>

namespace sprung {
namespace {

// Contacts are looked for this part of the thickness beyond the gap at most: the passes of a step move resting particles less.
constexpr double kMargin = 0.5;

/// For what the passes of a step may move [m].
double margin_of(const SpringNetwork& network, const std::vector<Obstacle>& obstacles) {
  double largest = 0.0;
  for (const Obstacle& obstacle : obstacles) largest = std::max(largest, obstacle.material.thickness);
  return kMargin * (particle_thickness(network).maxCoeff() + largest);
}

}  // namespace

ContactProjection::ContactProjection(const SpringNetwork& network, Environment& environment)
    : response_(network, environment),
      free_space_(environment, contact_surface(network), network.positions, margin_of(network, environment.obstacles())) {}

void ContactProjection::find(const StepMotion& motion) {
  free_space_.follow(motion.before, motion.advanced);
  response_.start(free_space_.contacts(motion.before, motion.advanced), motion);
}

void ContactProjection::find_again(const StepMotion& motion, const Points& positions) {
  response_.start_again(free_space_.contacts_again(motion.before, positions), motion);
}

void ContactProjection::truncate(const Points& before, Points& positions, const FreeSpace::Relax& relax) {
  const Truncation truncation = free_space_.truncate(before, positions, relax);
  truncated_ = truncation.truncated;
  squeezed_ = truncation.squeezed;
}

}  // namespace sprung
