#include "simulation/start/approach.h"

#include "dynamics/contact/collision_surface_builder.h"
#include "dynamics/state/simulation_state.h"

#include <cmath>

namespace sprung {

namespace {

// A body without segments and faces has no element size: it moves in so many strides.
constexpr int kStridesOfParticles = 8;

// Further strides, for particles that slide along an obstacle and so take a longer path.
constexpr int kMoreStrides = 32;

// Lower bound of a stopped particle's stride, as a fraction of a full stride.
constexpr double kShortest = 1.0 / 64.0;

// The approach ends when no particle moves by this fraction of a stride.
constexpr double kArrived = 1.0e-3;

// Afterwards, contact is solved until no particle moves by this fraction of a stride, at most so many times.
constexpr double kSettled = 1.0e-6;
constexpr int kMaxSettling = 16;

SpringNetwork only_moving(SpringNetwork network, Index body) {
  const Body& own = network.bodies[static_cast<std::size_t>(body)];
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (i < own.first_particle || i >= own.first_particle + own.particle_count) network.inverse_masses[i] = 0.0;
  }
  for (Body& each : network.bodies) each.material.friction = each.material.static_friction = 0.0;
  return network;
}

}  // namespace

Approach::Approach(const SpringNetwork& network, const ObstacleFrame& obstacles, Index body)
    : network_(only_moving(network, body)),
      length_(contact_surface(network_).element_size[static_cast<std::size_t>(body)]),
      obstacles_(obstacles),
      contacts_(network_, obstacles.set()) {}

double Approach::stride(Points& x, const Points& advanced) {
  const Points before = x;
  x = advanced;
  const Points none = Points::Zero(3, x.cols());
  const Slip no_slip{.displacement = none, .obstacle = std::vector<Index>(static_cast<std::size_t>(x.cols()), kNone)};
  const StepMotion motion{before, none, no_slip, advanced, 1.0};
  contacts_.find(obstacles_, motion);
  contacts_.push_out(x);
  contacts_.truncate(obstacles_, motion, x);
  return (x - before).colwise().norm().maxCoeff();
}

Points Approach::run(const Points& free, const Points& wanted) {
  const double path = (wanted - free).colwise().norm().maxCoeff();
  const double longest = length_ > 0.0 ? length_ : path / kStridesOfParticles;
  const int strides = static_cast<int>(std::ceil(path / longest)) + kMoreStrides;
  Scalars lengths = Scalars::Constant(free.cols(), longest);
  Points x = free;
  for (int k = 0; k < strides; ++k) {
    const Points before = x;
    Points advanced = x;
    for (Index i = 0; i < static_cast<Index>(x.cols()); ++i) {
      const Vector3 left = wanted.col(i) - x.col(i);
      const double distance = left.norm();
      advanced.col(i) = distance <= lengths[i] ? Vector3(wanted.col(i)) : Vector3(x.col(i) + lengths[i] / distance * left);
    }
    if (stride(x, advanced) <= kArrived * longest) break;
    // A stopped particle gets a short stride: the safe region of a long displacement spans much of an obstacle, at high cost.
    lengths = (2.0 * (x - before).colwise().norm().transpose()).cwiseMax(kShortest * longest).cwiseMin(longest);
  }
  for (int k = 0; k < kMaxSettling; ++k) {
    if (stride(x, Points(x)) <= kSettled * longest) break;
  }
  return x;
}

}  // namespace sprung
