#include "dynamics/forces/pull_force.h"

#include "dynamics/forces/force_derivatives.h"

#include <algorithm>

namespace sprung {
namespace {

constexpr double kTime = 0.1;             // [s]
constexpr double kExtentFraction = 0.05;  // a single particle of a fine cloth could not lift it

}  // namespace

PullForce::PullForce(const SpringNetwork& network, const Points& positions, Index particle, double step)
    : target_(positions.col(particle)) {
  const Body& body = network.body_of(particle);
  const auto of_body = positions.middleCols(body.first_particle, body.particle_count);
  const double extent = (of_body.rowwise().maxCoeff() - of_body.rowwise().minCoeff()).norm();
  double gripped_mass = 0.0;
  for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
    const Vector3 offset = positions.col(i) - target_;
    if (network.is_pinned(i) || (i != particle && offset.norm() > kExtentFraction * extent)) continue;
    grips_.push_back({.particle = i, .offset = offset, .stiffness = 0.0, .damping = 0.0});
    gripped_mass += network.masses[i];
  }
  const double body_mass = network.masses.segment(body.first_particle, body.particle_count).sum();
  for (Grip& grip : grips_) {
    const double mass = network.masses[grip.particle];
    const double share = body_mass * mass / gripped_mass;
    const double stiffness = share / (kTime * kTime);
    const double damping = std::max(2.0 * share / kTime, 2.0 * stiffness * step);
    const double denominator = 1.0 + (damping * step + stiffness * step * step) / mass;
    grip.stiffness = stiffness / denominator;
    grip.damping = damping / denominator;
  }
}

std::optional<std::vector<Index>> PullForce::touched() const {
  std::vector<Index> particles;
  for (const Grip& grip : grips_) particles.push_back(grip.particle);
  return particles;
}

Vector3 PullForce::force_on(const Grip& grip, const Points& x, const Points& v) const {
  const Vector3 displacement = x.col(grip.particle) - target_ - grip.offset;
  return -grip.stiffness * displacement - grip.damping * v.col(grip.particle);
}

Vector3 PullForce::total(const Points& x, const Points& v) const {
  Vector3 sum = Vector3::Zero();
  for (const Grip& grip : grips_) sum += force_on(grip, x, v);
  return sum;
}

void PullForce::add(const Kinematics& at, Points& forces) const {
  for (const Grip& grip : grips_) forces.col(grip.particle) += force_on(grip, at.x, at.v);
}

void PullForce::add_derivatives(const Kinematics&, ForceDerivatives& derivatives) const {
  for (const Grip& grip : grips_) {
    derivatives.by_position.add(grip.particle, grip.particle, -grip.stiffness * Matrix3::Identity());
    derivatives.by_velocity.add(grip.particle, grip.particle, -grip.damping * Matrix3::Identity());
  }
}

}  // namespace sprung
