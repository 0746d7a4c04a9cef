#include "dynamics/contact/contact_projection.h"

#include "dynamics/contact/collision_surface_builder.h"
#include "dynamics/networks.h"
#include "dynamics/state/simulation_state.h"
#include "network/network_helpers.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>

namespace sprung {
namespace {

/// A cloth that collides with itself, below another one.
SpringNetwork two_cloths() {
  NetworkBuilder builder;
  for (const auto& [name, height] : {std::pair("lower", 0.02), std::pair("upper", 0.05)}) {
    BodyShape shape = make_cloth({.resolution = {9, 9}}, {});
    set_total_mass(shape, 0.1);
    place(shape, RigidTransform(Eigen::Translation3d(0.0, 0.0, height)));
    builder.add_body(name, shape, {.thickness = 0.02}, {.self = true});
  }
  return builder.build();
}

/// All particles fall, and those that are free shake. Pins take their elements through the ball.
Points shaken(ContactProjection& contacts, const ObstacleFrame& obstacles, const SpringNetwork& network, Points x, int steps) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> within(-0.02, 0.02);
  const Points none = Points::Zero(3, x.cols());
  const Slip no_slip{.displacement = none, .obstacle = std::vector<Index>(static_cast<std::size_t>(x.cols()), kNone)};
  for (int step = 0; step < steps; ++step) {
    const Points before = x;
    for (Index i = 0; i < network.particle_count(); ++i) {
      x.col(i).z() -= 0.01;
      if (!network.is_fixed(i)) x.col(i) += Vector3(within(random), within(random), within(random));
    }
    const Points advanced = x;
    const StepMotion motion{before, none, no_slip, advanced, 1.0};
    contacts.find(obstacles, motion);
    contacts.push_out(x);
    contacts.truncate(obstacles, motion, x);
  }
  return x;
}

TEST(ContactProjection, WithOtherMotionsItIsAsNew) {
  SpringNetwork network = two_cloths();
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = 0.3}};
  ball.rest_pose.translation() = Vector3(0.0, 0.0, -0.3);
  const ObstacleSet obstacles({ball});
  const ObstacleFrame frame(obstacles, 0.0, 0.0);
  ContactProjection contacts(network, obstacles);
  const Points before = shaken(contacts, frame, network, network.positions, 20);
  testing::hold(network, {.particles = {0, 40, 161}, .motion = {}});
  contacts.set_motions(particle_motions(network));
  ContactProjection fresh(network, obstacles);
  const Points after = shaken(contacts, frame, network, before, 20);
  EXPECT_GT(contacts.truncated_count(), 0);
  EXPECT_EQ(after, shaken(fresh, frame, network, before, 20));
  EXPECT_GT(fresh.infeasible_count(), 0);
  EXPECT_EQ(contacts.infeasible_count(), fresh.infeasible_count());
}

}  // namespace
}  // namespace sprung
