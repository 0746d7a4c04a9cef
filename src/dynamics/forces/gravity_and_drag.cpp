#include "dynamics/forces/gravity_and_drag.h"

#include "base/parallel.h"
#include "dynamics/forces/force_derivatives.h"

#include <algorithm>
#include <utility>

namespace sprung {
namespace {

constexpr Index kParticleChunk = 8192;

}  // namespace

Gravity::Gravity(const SpringNetwork& network, const Vector3& acceleration)
    : masses_(network.masses), acceleration_(acceleration) {}

void Gravity::add(const Kinematics&, Points& forces) const {
  parallel_chunks(static_cast<Index>(masses_.size()), kParticleChunk, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) forces.col(i) += masses_[i] * acceleration_;
  });
}

double Gravity::energy(const Points& positions) const {
  double energy = 0.0;
  for (Index i = 0; i < positions.cols(); ++i) energy -= (masses_[i] * acceleration_).dot(positions.col(i));
  return energy;
}

AirDrag::AirDrag(const SpringNetwork& network, double drag, Wind wind) : network_(network), drag_(drag), wind_(std::move(wind)) {
  for (Index i = 0; i < network.particle_count(); ++i) {
    rate_ = std::max(rate_, drag * network.drag_areas[i] * network.inverse_masses[i]);
  }
}

void AirDrag::add(const Kinematics& at, Points& forces) const {
  const bool gusty = wind_.gusts().has_value();
  const Points air = gusty ? wind_.velocities(at.x, at.time) : Points(wind_.mean(at.time));
  parallel_chunks(network_.particle_count(), kParticleChunk, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      forces.col(i) -= drag_ * network_.drag_areas[i] * (at.v.col(i) - air.col(gusty ? i : 0));
    }
  });
}

void AirDrag::add_derivatives(const Kinematics&, ForceDerivatives& derivatives) const {
  for (Index i = 0; i < network_.particle_count(); ++i) {
    derivatives.by_velocity.add(i, i, -drag_ * network_.drag_areas[i] * Matrix3::Identity());
  }
}

void AirDrag::append_elements(std::vector<LinearElement>& elements) const {
  for (Index i = 0; i < network_.particle_count(); ++i) {
    elements.push_back(LinearElement::anchor(i, 0.0, drag_ * network_.drag_areas[i]));
  }
}

double AirDrag::largest_acceleration() const { return rate_ * wind_.max_speed(); }

}  // namespace sprung
