// A gripper that a program steers: two fingers close on a soft cube until they hold it, lift it, carry it aside, and open.
#include "collision/shapes/obstacle.h"
#include "network/network_builder.h"
#include "simulation/simulator.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

using sprung::Vector3;
constexpr double kStep = 0.0004;  // [s]

/// Moves the left finger by `left` and the right one by `right` [m/s] for some seconds, or until they touch `enough` particles.
/// The ground touches those of the bottom.
void move(sprung::Simulator& gripper, const Vector3& left, const Vector3& right, double seconds, long enough = 1000) {
  const auto is_high = [&](sprung::Index i) { return gripper.positions()(1, i) > 0.02; };
  const long steps = std::lround(seconds / kStep);
  for (long step = 0; step < steps && std::ranges::count_if(gripper.contact_particles(), is_high) < enough; ++step) {
    for (const std::size_t finger : {0U, 1U}) {
      sprung::RigidTransform pose = gripper.obstacle_pose(finger);
      pose.translation() += kStep * (finger == 0 ? left : right);
      gripper.move_obstacle(finger, pose);
    }
    gripper.step();
  }
  std::cout << gripper.time() << " s: the cube is at " << gripper.positions().rowwise().mean().transpose() << '\n';
}

int main() {
  const sprung::SpringMaterial soft{.value = 50.0, .damping = 0.1};  // [N/m], [N s/m]
  sprung::BodyShape cube =
      sprung::make_solid({.size = {0.1, 0.1, 0.1}, .resolution = {5, 5, 5}}, {.structural = soft, .shear = soft});
  sprung::set_total_mass(cube, 0.1);
  sprung::place(cube, sprung::RigidTransform(Eigen::Translation3d(0.0, 0.054, 0.0)));
  const sprung::ContactMaterial rough{.thickness = 0.002, .friction = 0.8};
  sprung::NetworkBuilder builder;
  builder.add_body("cube", cube, rough);
  const sprung::BoxGeometry finger{.size = {0.02, 0.06, 0.12}};
  sprung::Obstacle left{.name = "left", .geometry = finger, .material = rough};
  left.rest_pose.translation() = Vector3(-0.1, 0.06, 0.0);
  sprung::Obstacle right{.name = "right", .geometry = finger, .material = rough};
  right.rest_pose.translation() = Vector3(0.1, 0.06, 0.0);
  const sprung::Obstacle ground{.name = "ground", .geometry = sprung::HalfSpaceGeometry{}, .material = rough};
  sprung::Simulator gripper(builder.build(), {.step = kStep}, {left, right, ground});

  const Vector3 along(0.2, 0.0, 0.0);  // [m/s]
  const Vector3 up(0.0, 0.2, 0.0);
  move(gripper, along, -along, 1.0, 20);  // closes until it touches 20 of the 40 particles beside the fingers
  move(gripper, along, -along, 0.04);     // squeezes
  move(gripper, up, up, 1.0);
  const double height = gripper.positions().row(1).mean();
  move(gripper, along, along, 1.0);
  move(gripper, -along, along, 0.2);
  move(gripper, Vector3::Zero(), Vector3::Zero(), 1.0);
  const Vector3 end = gripper.positions().rowwise().mean();
  return height > 0.2 && end.x() > 0.15 && end.y() < 0.06 ? 0 : 1;
}
