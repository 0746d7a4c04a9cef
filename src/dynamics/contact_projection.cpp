#include "dynamics/contact_projection.h"

#include "dynamics/contact_pair.h"
#include "dynamics/contact_surface.h"

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

ContactProjection::ContactProjection(const SpringNetwork& network, Environment& environment)
    : environment_(environment),
      response_(network, environment),
      thickness_(particle_thickness(network)),
      margin_(kMargin * (thickness_.maxCoeff() + largest_thickness(environment.obstacles()))),
      free_space_(environment, contact_surface(network), margin_) {}

void ContactProjection::find(const StepMotion& motion) {
  free_space_.follow(motion.before, motion.advanced);
  std::vector<Contact> contacts = environment_.contacts({motion.before, motion.advanced, thickness_, margin_});
  const std::vector<Contact> of_elements = free_space_.element_contacts(motion.advanced);
  contacts.insert(contacts.end(), of_elements.begin(), of_elements.end());
  response_.start(contacts, motion);
}

void ContactProjection::truncate(const Points& before, Points& positions) {
  const FreeSpace::Truncation truncation = free_space_.truncate(before, positions);
  truncated_ = truncation.truncated;
  squeezed_ = truncation.squeezed;
}

}  // namespace sprung
