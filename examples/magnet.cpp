// A force of one's own: a magnet lifts the end of a hanging chain of iron beads.
#include "dynamics/forces/force.h"
#include "network/network_builder.h"
#include "simulation/simulator.h"

#include <iostream>
#include <memory>

/// Pulls each particle towards a point with c m / (r^2 + h^2), r its distance from the point.
class Magnet final : public sprung::Force {
 public:
  Magnet(const sprung::SpringNetwork& network, const sprung::Vector3& at, double strength)
      : masses_(network.masses), at_(at), strength_(strength) {}

  void add(const sprung::Kinematics& now, sprung::Points& forces) const override {
    for (sprung::Index i = 0; i < masses_.size(); ++i) {
      const sprung::Vector3 towards = at_ - now.x.col(i);
      forces.col(i) += strength_ * masses_[i] / (towards.squaredNorm() + kCore * kCore) * towards.normalized();
    }
  }

 private:
  static constexpr double kCore = 0.05;  // h [m]
  sprung::Scalars masses_;
  sprung::Vector3 at_;
  double strength_;  // c [m^3/s^2]
};

int main() {
  sprung::SpringMaterials springs;
  springs.structural = sprung::SpringMaterial{.value = 500.0, .damping = 0.5};  // [N/m], [N s/m]
  sprung::BodyShape chain = sprung::make_rope({.points = {{0, 0, 0}, {0, -1, 0}}, .particles = 21}, springs);
  sprung::set_total_mass(chain, 0.1);
  sprung::NetworkBuilder builder;
  builder.add_body("chain", chain);
  builder.pin(0);

  sprung::Simulator simulator(builder.build(), {.step = 0.0005});
  simulator.add_force(std::make_unique<Magnet>(simulator.network(), sprung::Vector3(0.5, -0.8, 0), 2.0));
  while (simulator.time() < 2.0) simulator.step();
  const sprung::Vector3 end = simulator.positions().col(20);
  std::cout << "after 2 s the last bead is at " << end.transpose() << '\n';
  return end.x() > 0.2 ? 0 : 1;
}
