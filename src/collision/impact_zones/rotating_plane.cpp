#include "collision/impact_zones/rotating_plane.h"

#include "collision/impact_zones/kabsch.h"

namespace sprung {

namespace {

// Free particles have the weight 1.
constexpr double kWeightOfPins = 1024.0;

}  // namespace

RotatingPlane rotating_plane(const ContactStencil& pair, const Points& before, const Points& ends, const ParticleMotions& motions) {
  const auto weight = [&](Index i) { return is_fixed(motions, i) ? kWeightOfPins : 1.0; };
  Vector3 center_before = Vector3::Zero();
  Vector3 center_after = Vector3::Zero();
  double sum = 0.0;
  for (int k = 0; k < pair.count(); ++k) {
    const Index i = pair.particles[static_cast<std::size_t>(k)];
    center_before += weight(i) * before.col(i);
    center_after += weight(i) * ends.col(i);
    sum += weight(i);
  }
  center_before /= sum;
  center_after /= sum;
  Matrix3 covariance = Matrix3::Zero();
  for (int k = 0; k < pair.count(); ++k) {
    const Index i = pair.particles[static_cast<std::size_t>(k)];
    covariance += weight(i) * (ends.col(i) - center_after) * (before.col(i) - center_before).transpose();
  }
  return {pair.normal, kabsch_rotation(covariance) * pair.normal};
}

}  // namespace sprung
