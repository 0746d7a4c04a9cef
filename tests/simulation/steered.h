// A rope, pins and obstacles that a program steers, and what the simulator says if it refuses.
#pragma once

#include "base/error.h"
#include "simulation/scenes.h"

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace sprung::testing {

inline constexpr double kStep = 0x1p-10;  // [s]
inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
inline constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

inline const ContactMaterial kRough{.thickness = 0.005, .friction = 0.4, .static_friction = 0.4};

inline RigidTransform pose_at(const Vector3& position, const Vector3& degrees = Vector3::Zero()) {
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees(degrees);
  pose.translation() = position;
  return pose;
}

inline RigidTransform shifted(RigidTransform pose, const Vector3& by) {
  pose.translation() += by;
  return pose;
}

inline Obstacle ball(const Vector3& position, double radius = 0.1) {
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = radius}, .material = kRough};
  ball.rest_pose.translation() = position;
  return ball;
}

/// 2 m below the origin.
inline Obstacle low_ground() {
  Obstacle low = ground(kRough);
  low.rest_pose.translation() = Vector3(0.0, -2.0, 0.0);
  return low;
}

inline SimulatorSettings settings_of(const Vector3& gravity = {0.0, -kGravity, 0.0}) { return {.step = kStep, .gravity = gravity}; }

/// A rope of 1 m and 11 particles from the origin along x, and pins of its ends.
inline SpringNetwork rope(std::vector<Pin> pins) {
  BodyShape shape = make_rope({.points = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, .particles = 11},
                              {.structural = SpringMaterial{.value = 100.0, .damping = 0.1}});
  set_total_mass(shape, 0.1);
  NetworkBuilder builder;
  builder.add_body("rope", shape, {.thickness = 0.005});
  for (Pin& pin : pins) builder.add_pin(std::move(pin));
  return builder.build();
}

inline Pin hand(std::vector<Index> particles, const Motion& motion = {}) {
  Pin pin;
  pin.particles = std::move(particles);
  pin.motion = motion;
  pin.name = "hand";
  return pin;
}

/// Forth and back, with a rotation; keys lie on steps.
inline Motion keyframes() {
  return {.keyframes = {{.time = 64 * kStep},
                        {.time = 128 * kStep, .position = {0.05, 0.1, 0.0}, .rotation = {0.0, 0.0, 30.0}},
                        {.time = 256 * kStep, .position = {0.0, 0.15, 0.1}, .rotation = {0.0, 0.0, -20.0}}}};
}

inline double farthest(const Simulator& a, const Simulator& b) {
  return (a.positions() - b.positions()).colwise().norm().maxCoeff();
}

inline std::string refusal(const std::function<void()>& change) {
  try {
    change();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace sprung::testing
