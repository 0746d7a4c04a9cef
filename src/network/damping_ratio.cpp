#include "network/damping_ratio.h"

#include "network/stiffness_estimate.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

/// The mean of the body's pinned particles or, without pins, its centre of mass.
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

/// sum m weight(r^2) of the body's particles at distances r from its fixed point.
template <class Weight>
double inertia(const SpringNetwork& network, const Body& body, const Weight& weight) {
  const Vector3 centre = fixed_point(network, body);
  double sum = 0.0;
  for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
    sum += network.masses[i] * weight((network.positions.col(i) - centre).squaredNorm());
  }
  return sum;
}

double frequency(double stiffness, double inertia) { return inertia > 0.0 ? std::sqrt(stiffness / inertia) : 0.0; }

/// k_d / k [s] of a damping ratio; 0 for a body that does not oscillate.
double damping_time(double ratio, double omega) { return omega > 0.0 ? 2.0 * ratio / omega : 0.0; }

}  // namespace

double breathing_frequency(const SpringNetwork& network, const Body& body) {
  const Springs& springs = network.springs;
  double stiffness = 0.0;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    stiffness += springs.stiffness[s] * springs.rest_length[s] * springs.rest_length[s];
  }
  return frequency(stiffness, inertia(network, body, [](double squared) { return squared; }));
}

double bending_frequency(const SpringNetwork& network, const Body& body) {
  return frequency(bending_resistance(network, body),
                   inertia(network, body, [](double squared) { return squared * squared / 4.0; }));
}

void damp_by_ratio(const std::array<std::optional<double>, 3>& ratios, const Body& body, SpringNetwork& network) {
  if (std::none_of(ratios.begin(), ratios.end(), [](const auto& ratio) { return ratio.has_value(); })) return;
  const double breathing = breathing_frequency(network, body);
  Springs& springs = network.springs;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    const std::optional<double>& ratio = ratios[static_cast<std::size_t>(springs.kind[s])];
    if (ratio) springs.damping[s] = damping_time(*ratio, breathing) * springs.stiffness[s];
  }
  const std::optional<double>& ratio = ratios[static_cast<std::size_t>(SpringKind::bend)];
  if (!ratio) return;
  const double bending = bending_frequency(network, body);
  AngleBends& bends = network.angle_bends;
  for (Index a = body.first_angle_bend; a < body.first_angle_bend + body.angle_bend_count; ++a) {
    bends.damping[a] = damping_time(*ratio, bending) * bends.stiffness[a];
  }
  FaceBends& faces = network.face_bends;
  for (Index f = body.first_face_bend; f < body.first_face_bend + body.face_bend_count; ++f) {
    faces.damping[f] = damping_time(*ratio, bending) * faces.stiffness[f];
  }
}

}  // namespace sprung
