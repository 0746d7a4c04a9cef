#include "simulation/start/approach.h"

#include "dynamics/contact/collision_surface_builder.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

// Particles on their own have no size: they come back in so many strides.
constexpr int kStridesOfParticles = 8;

// What slides along an obstacle has as many strides as the whole way back took, and so many more.
constexpr int kMoreStrides = 32;

// Strides of what was stopped are this part of the others at least.
constexpr double kShortest = 1.0 / 64.0;

// A stride that takes no particle this part of it farther was the last.
constexpr double kArrived = 1.0e-3;

// In the end what is in contact finds its gap, until nothing moves by this part of a stride, or so often.
constexpr double kSettled = 1.0e-6;
constexpr int kMostSettling = 16;

// As in a step of a simulation.
constexpr int kContactPasses = 8;
constexpr double kContactTolerance = 1.0e-3;

SpringNetwork only_moving(SpringNetwork network, Index body) {
  const Body& own = network.bodies[static_cast<std::size_t>(body)];
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (i < own.first_particle || i >= own.first_particle + own.particle_count) network.inverse_masses[i] = 0.0;
  }
  for (Body& each : network.bodies) each.material.friction = each.material.static_friction = 0.0;
  return network;
}

}  // namespace

WayBack::WayBack(const SpringNetwork& network, Environment& environment, Index body)
    : network_(only_moving(network, body)),
      length_(contact_surface(network_).element_size[static_cast<std::size_t>(body)]),
      contacts_(network_, environment) {}

double WayBack::stride(Points& x, const Points& advanced) {
  const Points before = x;
  x = advanced;
  const Points v = Points::Zero(3, x.cols());
  const StepMotion motion{before, v, advanced, 1.0};
  contacts_.find(motion);
  for (int pass = 0; pass < kContactPasses; ++pass) {
    if (contacts_.project(x) <= kContactTolerance) break;
  }
  contacts_.truncate(motion, x);
  return (x - before).colwise().norm().maxCoeff();
}

Points WayBack::walk(const Points& free, const Points& wanted) {
  const double way = (wanted - free).colwise().norm().maxCoeff();
  const double longest = length_ > 0.0 ? length_ : way / kStridesOfParticles;
  const int strides = static_cast<int>(std::ceil(way / longest)) + kMoreStrides;
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
    // What is stopped is not pulled at in vain: regions for long ways hold much of an obstacle.
    lengths = (2.0 * (x - before).colwise().norm().transpose()).cwiseMax(kShortest * longest).cwiseMin(longest);
  }
  for (int k = 0; k < kMostSettling; ++k) {
    if (stride(x, Points(x)) <= kSettled * longest) break;
  }
  return x;
}

}  // namespace sprung
