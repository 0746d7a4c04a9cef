#include "network/damping_ratio.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

/// The mean of the body's pinned particles, or its centre of mass.
Vector3 fixed_point(const SpringNetwork& network, const Body& body) {
  Vector3 pinned = Vector3::Zero();
  Vector3 weighted = Vector3::Zero();
  double mass = 0.0;
  Index pins = 0;
  for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
    if (network.is_pinned(i)) {
      pinned += network.positions.col(i);
      ++pins;
    }
    weighted += network.masses[i] * network.positions.col(i);
    mass += network.masses[i];
  }
  return pins > 0 ? Vector3(pinned / pins) : Vector3(weighted / mass);
}

}  // namespace

double breathing_frequency(const SpringNetwork& network, const Body& body) {
  const Vector3 centre = fixed_point(network, body);
  double inertia = 0.0;
  for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
    inertia += network.masses[i] * (network.positions.col(i) - centre).squaredNorm();
  }
  const Springs& springs = network.springs;
  double stiffness = 0.0;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    stiffness += springs.stiffness[s] * springs.rest_length[s] * springs.rest_length[s];
  }
  return inertia > 0.0 ? std::sqrt(stiffness / inertia) : 0.0;
}

void damp_by_ratio(const std::array<std::optional<double>, 3>& ratios, const Body& body, SpringNetwork& network) {
  if (std::none_of(ratios.begin(), ratios.end(), [](const auto& ratio) { return ratio.has_value(); })) return;
  const double omega = breathing_frequency(network, body);
  if (omega == 0.0) return;
  Springs& springs = network.springs;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    const std::optional<double>& ratio = ratios[static_cast<std::size_t>(springs.kind[s])];
    if (ratio) springs.damping[s] = 2.0 * *ratio * springs.stiffness[s] / omega;
  }
}

}  // namespace sprung
