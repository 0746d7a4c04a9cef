#include "network/network_builder.h"
#include "simulation/simulator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sprung {
namespace {

constexpr double kSpan = 1.0;    // [m]
constexpr double kLength = 1.5;  // [m]

/// Sag of an inextensible rope (Bernoulli, Huygens and Leibniz 1691): a (cosh(w / 2a) - 1) with 2a sinh(w / 2a) its length.
double sag_of_catenary() {
  double small = 0.01;
  double large = 100.0;
  while (large - small > 1.0e-14) {
    const double a = 0.5 * (small + large);
    (2.0 * a * std::sinh(0.5 * kSpan / a) > kLength ? small : large) = a;
  }
  return small * (std::cosh(0.5 * kSpan / small) - 1.0);
}

/// A rope in the shape of a V, pinned at both ends.
SpringNetwork hanging_between_two_points() {
  const double depth = 0.5 * std::sqrt(kLength * kLength - kSpan * kSpan);
  BodyShape shape =
      make_rope({.points = {{0.0, 0.0, 0.0}, {0.5 * kSpan, -depth, 0.0}, {kSpan, 0.0, 0.0}}, .particles = 61, .length = {}},
                {.structural = SpringMaterial{}, .shear = {}, .bend = {}});
  set_total_mass(shape, 0.1);
  NetworkBuilder builder;
  builder.add_body("rope", shape);
  builder.pin({0, 60});
  return builder.build();
}

double simulated_sag(double step, const StretchLimitSettings& limit) {
  Simulator simulator(hanging_between_two_points(),
                      {.step = step, .integrator = VerletSettings{.damping_rate = 6.0}, .stretch_limit = limit});
  while (simulator.time() < 3.0) simulator.step();
  return -simulator.positions().row(1).minCoeff();
}

// A chain of 60 links sags by a fraction of about 1 / 60^2 less than a rope. Gravity adds g dt^2 per step to each of 30 particles.
// 8 passes leave 2 * 30 / 8 of that on the topmost spring of 0.025 m: 0.02 %, and less further down. A global solve leaves
// nothing.
TEST(Catenary, IsTheShapeOfARopeThatDoesNotStretch) {
  const StretchLimitSettings passes{.max_stretch = 0.0, .iterations = 8, .tolerance = 0.0};
  StretchLimitSettings tethered = passes;
  tethered.tethers = true;
  const StretchLimitSettings solved{.max_stretch = 0.0, .tolerance = 1e-4, .solver = StretchLimitSettings::Solver::newton};
  const double sag = sag_of_catenary();
  EXPECT_NEAR(simulated_sag(1.0 / 4000.0, passes), sag, 0.005 * sag);
  EXPECT_NEAR(simulated_sag(1.0 / 4000.0, tethered), sag, 0.005 * sag);
  EXPECT_NEAR(simulated_sag(1.0 / 60.0, solved), sag, 0.005 * sag);
}

}  // namespace
}  // namespace sprung
