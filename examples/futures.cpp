// A crane that looks ahead: before each move it copies the simulator, tries four speeds, and takes the one with the best future.
#include "network/network_builder.h"
#include "simulation/simulator.h"

#include <cmath>
#include <iostream>
#include <limits>

constexpr double kGoal = 1.0;  // along x, where the load shall hang at rest [m]

/// Moves the crane at a speed [m/s] for some seconds.
void drive(sprung::Simulator& crane, double speed, double seconds) {
  const long steps = std::lround(seconds / crane.settings().step);
  for (long step = 0; step < steps; ++step) {
    sprung::RigidTransform pose = crane.pin_pose(0);
    pose.translation().x() += speed * crane.settings().step;
    crane.move_pin(0, pose);
    crane.step();
  }
}

/// Distance of load and crane from the goal, plus the path of the load in 0.3 s [m].
double badness(const sprung::Simulator& crane) {
  const sprung::SimulationState& state = crane.state();
  const double load = std::hypot(state.x(0, 10) - kGoal, 0.3 * state.v(0, 10));
  return load + std::abs(state.x(0, 0) - kGoal);
}

int main() {
  const sprung::SpringMaterial steel{.value = 2000.0, .damping = 2.0};  // [N/m], [N s/m]
  sprung::BodyShape rope = sprung::make_rope({.points = {{0, 0, 0}, {0, -1, 0}}, .particles = 11}, {.structural = steel});
  sprung::set_total_mass(rope, 0.1);
  rope.masses.back() += 1.0;  // the load [kg]
  sprung::NetworkBuilder builder;
  builder.add_body("rope", rope);
  builder.pin(0);
  sprung::Simulator crane(builder.build(), {.step = 0.001});

  for (int move = 0; move < 80; ++move) {
    double best_speed = 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (const double speed : {-0.1, 0.0, 0.1, 0.4}) {
      sprung::Simulator future = crane;  // shares the model
      drive(future, speed, 0.1);
      drive(future, 0.0, 0.4);
      if (badness(future) >= least) continue;
      least = badness(future);
      best_speed = speed;
    }
    drive(crane, best_speed, 0.1);
  }
  std::cout << "after " << crane.time() << " s the load is at " << crane.positions().col(10).transpose() << '\n';
  return badness(crane) < 0.05 ? 0 : 1;
}
