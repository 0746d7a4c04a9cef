// A constraint of one's own: a pearl slides down a straight wire, and pulls a thread behind it.
#include "dynamics/constraints/constraint.h"
#include "network/network_builder.h"
#include "simulation/simulator.h"

#include <iostream>
#include <memory>

/// Keeps a particle on the line through a point along a direction of unit length.
class Rail final : public sprung::Constraint {
 public:
  Rail(sprung::Index particle, const sprung::Vector3& point, const sprung::Vector3& direction)
      : particle_(particle), point_(point), direction_(direction) {}

  double project(const sprung::Points& /*before*/, sprung::Points& positions,
                 const sprung::ImpulseRecorder& /*recorder*/) const override {
    const sprung::Vector3 off = offset(positions);
    positions.col(particle_) -= off;  // the wire has no mass that could give way
    return off.norm() / kTolerance;
  }
  [[nodiscard]] double residual(const sprung::Points& positions) const override { return offset(positions).norm() / kTolerance; }

 private:
  static constexpr double kTolerance = 1.0e-9;  // [m]
  [[nodiscard]] sprung::Vector3 offset(const sprung::Points& positions) const {
    const sprung::Vector3 from_point = positions.col(particle_) - point_;
    return from_point - from_point.dot(direction_) * direction_;
  }
  sprung::Index particle_;
  sprung::Vector3 point_;
  sprung::Vector3 direction_;
};

int main() {
  sprung::NetworkBuilder builder;
  const auto pearl = builder.add_particle({0, 0, 0}, 0.1);
  const auto end = builder.add_particle({0, -0.2, 0}, 0.01);
  builder.add_spring(pearl, end, 200.0, 0.2, 0.1);
  sprung::Simulator simulator(builder.build(), {.step = 0.001});
  const sprung::Vector3 slope = sprung::Vector3(1, -1, 0).normalized();
  simulator.add_constraint(std::make_unique<Rail>(pearl, sprung::Vector3::Zero(), slope));
  while (simulator.time() < 1.0) simulator.step();
  const sprung::Vector3 position = simulator.positions().col(pearl);
  std::cout << "after 1 s the pearl is at " << position.transpose() << '\n';
  const double down = position.dot(slope);
  return (position - down * slope).norm() < 1.0e-9 && down > 3.0 ? 0 : 1;
}
