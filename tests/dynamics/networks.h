// Networks that the tests of this folder share.
#pragma once

#include "network/network_builder.h"

#include <random>

namespace sprung {

/// A square cloth of side x side particles, 1 m wide, its two `max` corners pinned if `pinned`.
inline SpringNetwork make_test_cloth(Index side, double stiffness, double damping, bool pinned = true, double mass = 0.2) {
  SpringMaterials materials;
  materials.structural = SpringMaterial{.value = stiffness, .damping = damping};
  materials.shear = SpringMaterial{.value = 0.5 * stiffness, .damping = 0.5 * damping};
  materials.bend = SpringMaterial{.value = 0.1 * stiffness, .damping = 0.1 * damping};
  BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {side, side}}, materials);
  set_total_mass(shape, mass);
  NetworkBuilder builder;
  builder.add_body("cloth", shape);
  if (pinned) builder.pin({side * (side - 1), side * side - 1});
  return builder.build();
}

/// Springs between random particles in a box of 1 m: no runs. Masses from 0.1 to 1 kg, stiffness to 100 N/m, damping to 1 N s/m.
inline SpringNetwork make_random_network(Index particles, Index springs, bool pin_one = false) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  NetworkBuilder builder;
  const auto vector = [&] { return Vector3(unit(random), unit(random), unit(random)); };
  for (Index i = 0; i < particles; ++i) {
    const Vector3 position = vector();
    builder.add_particle(position, 0.1 + 0.9 * unit(random), vector());
  }
  for (Index s = 0; s < springs; ++s) {
    const auto a = static_cast<Index>(random() % static_cast<unsigned>(particles));
    const auto b = static_cast<Index>(random() % static_cast<unsigned>(particles));
    const double stiffness = 100.0 * unit(random);
    const double rest_length = unit(random);
    if (a != b) builder.add_spring(a, b, stiffness, rest_length, unit(random));
  }
  if (pin_one) builder.pin(0);
  return builder.build();
}

/// Two particles of `mass` on the x axis, `distance` apart, joined by one spring. The first one may be pinned.
inline SpringNetwork make_pair(double distance, double stiffness, double rest_length, double damping = 0.0, bool pinned = false,
                               double mass = 1.0) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), mass);
  builder.add_particle(Vector3(distance, 0.0, 0.0), mass);
  builder.add_spring(0, 1, stiffness, rest_length, damping);
  if (pinned) builder.pin(0);
  return builder.build();
}

/// A rope along x of `particles`, 1 m long, its first particle pinned.
inline SpringNetwork make_test_rope(Index particles, double stiffness, double mass = 0.1) {
  SpringMaterials materials;
  materials.structural = SpringMaterial{.value = stiffness};
  BodyShape shape = make_rope({.points = {Vector3::Zero(), Vector3::UnitX()}, .particles = particles, .length = {}}, materials);
  set_total_mass(shape, mass);
  NetworkBuilder builder;
  builder.add_body("rope", shape);
  builder.pin(0);
  return builder.build();
}

}  // namespace sprung
