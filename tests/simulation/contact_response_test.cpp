// Contact laws with closed forms, for each integrator: rest, sliding, bouncing, friction on moving obstacles.
#include "simulation/diagnostics.h"
#include "simulation/scenes.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

using testing::ground;
using testing::kGravity;
using testing::one_particle;
using testing::run;

/// The integrators, then those that may have inner substeps with four of them.
std::vector<SimulatorSettings> all_settings() {
  std::vector<SimulatorSettings> all;
  for (const IntegratorSettings& integrator : all_integrators()) all.push_back({.integrator = integrator});
  for (const IntegratorSettings& integrator : all_integrators()) {
    const SimulatorSettings settings{.integrator = integrator, .inner_substeps = 4};
    if (may_have_inner_substeps(settings)) all.push_back(settings);
  }
  return all;
}

class ContactSolver : public ::testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] SimulatorSettings settings(double step) const {
    SimulatorSettings settings = all_settings()[GetParam()];
    settings.step = step;
    return settings;
  }
};

INSTANTIATE_TEST_SUITE_P(Integrators, ContactSolver, ::testing::Range(std::size_t{0}, all_settings().size()));

TEST_P(ContactSolver, AParticleComesToRestAtItsThickness) {
  Simulator simulator(one_particle({0.0, 0.3, 0.0}, {.thickness = 0.01}), settings(1e-3), {ground({.thickness = 0.002})});
  run(simulator, 2.0);
  // A step of free fall from rest is g dt^2 = 1e-5 m, and explicit Euler lags by one step.
  EXPECT_NEAR(simulator.positions()(1, 0), 0.012, 1.1e-5);
  EXPECT_LE(simulator.state().v.col(0).norm(), 1.01 * kGravity * 1e-3);
}

TEST_P(ContactSolver, AParticleSticksBelowTheCriticalAngleAndSlidesAboveIt) {
  const double mu = 0.3;
  const ContactMaterial rough{.thickness = 0.01, .friction = mu, .static_friction = mu};
  for (const double factor : {0.99, 1.01}) {
    const double angle = std::atan(mu * factor);
    const Vector3 start = 0.01 * Vector3(-std::sin(angle), std::cos(angle), 0.0);
    Simulator simulator(one_particle(start, rough), settings(1e-3), {ground({.friction = mu, .static_friction = mu}, angle)});
    run(simulator, 1.0);
    const double slid = (simulator.positions().col(0) - start).norm();
    // Beyond the critical angle: 1/2 g (sin - mu cos) t^2 = 0.5 * 9.81 * 0.00287 = 1.4 cm. Below it, only the first step moves the
    // particle.
    if (factor < 1.0) {
      EXPECT_LT(slid, 2e-5);
    } else {
      EXPECT_NEAR(slid, 0.5 * kGravity * (std::sin(angle) - mu * std::cos(angle)), 0.02 * slid);
    }
  }
}

TEST_P(ContactSolver, ASlidingParticleStopsAfterItsStoppingDistance) {
  const double mu = 0.4;
  const double speed = 2.0;
  const ContactMaterial rough{.thickness = 0.01, .friction = mu, .static_friction = mu};
  Simulator simulator(one_particle({0.0, 0.01, 0.0}, rough, {speed, 0.0, 0.0}), settings(1e-3),
                      {ground({.friction = mu, .static_friction = mu})});
  run(simulator, 1.0);
  const double distance = speed * speed / (2.0 * mu * kGravity);
  // Friction begins and ends within a step: the error is at most v dt at each end.
  EXPECT_NEAR(simulator.positions()(0, 0), distance, 2.0 * speed * 1e-3);
}

/// The greatest height [m] that particle 0 reaches after its first bounce.
double height_of_bounce(Simulator& simulator) {
  while (simulator.state().v(1, 0) <= 0.0) simulator.step();
  double highest = 0.0;
  while (simulator.state().v(1, 0) > 0.0) {
    simulator.step();
    highest = std::max(highest, simulator.positions()(1, 0));
  }
  return highest;
}

/// A floor, a ball and a sheet whose highest points are at the origin.
std::vector<Obstacle> landing_surfaces() {
  Obstacle ball{.name = "ball", .geometry = SphereGeometry{.radius = 0.5}};
  ball.rest_pose.translation() = Vector3(0.0, -0.5, 0.0);
  return {ground(), ball, testing::sheet(3.0)};
}

TEST_P(ContactSolver, ABounceReachesTheSquareOfRestitutionTimesTheHeightAtAnyStep) {
  const double e = 0.8;
  for (const Obstacle& obstacle : landing_surfaces()) {
    for (const double step : {2.5e-4, 1e-3, 4e-3, 1.0 / 60.0}) {
      for (const double height : {1.0, 1.01, 1.02, 1.03, 1.04}) {
        Simulator simulator(one_particle({0.0, height + 0.01, 0.0}, {.thickness = 0.01, .restitution = e}), settings(step),
                            {obstacle});
        // The schemes sample exact parabolas. A sample is within half a step of the apex, so at most g (dt / 2)^2 / 2 below it.
        // The Euler schemes' first parabola has speed 0 half a step from the start, so its apex is higher by the same amount.
        const double sampling = kGravity * step * step / 8.0;
        EXPECT_NEAR(height_of_bounce(simulator), 0.01 + e * e * height, sampling + 1e-12) << obstacle.name << ", step " << step;
      }
    }
  }
}

TEST_P(ContactSolver, AClothDroppedFlatBouncesAsAParticle) {
  const double e = 0.6;
  const double height = 0.4;
  for (const Obstacle& obstacle : {ground(), testing::sheet(3.0)}) {
    for (const double step : {5e-4, 2e-3}) {
      Simulator simulator(testing::cloth(9, height + 0.01, {.thickness = 0.01, .restitution = e}), settings(step), {obstacle});
      const Points flat = simulator.positions();
      EXPECT_NEAR(height_of_bounce(simulator), 0.01 + e * e * height, kGravity * step * step / 8.0 + 1e-12);
      // All particles fall and bounce at once: no spring is stretched.
      const Points moved = simulator.positions() - flat;
      EXPECT_LT((moved.colwise() - moved.col(0)).cwiseAbs().maxCoeff(), 1e-9) << obstacle.name << ", step " << step;
    }
  }
}

TEST_P(ContactSolver, ARestingParticleDoesNotBounce) {
  Simulator simulator(one_particle({0.0, 0.01, 0.0}, {.thickness = 0.01, .restitution = 1.0}), settings(1e-3), {ground()});
  for (int i = 0; i < 500; ++i) {
    simulator.step();
    ASSERT_NEAR(simulator.positions()(1, 0), 0.01, 1.1e-5) << "step " << i;
  }
}

TEST_P(ContactSolver, AMovingPlateMovesAParticleByFriction) {
  const double mu = 0.5;
  const ContactMaterial rough{.thickness = 0.01, .friction = mu, .static_friction = mu};
  Obstacle plate{
      .name = "plate", .geometry = BoxGeometry{.size = {4.0, 0.2, 4.0}}, .material = {.friction = mu, .static_friction = mu}};
  plate.rest_pose.translation() = Vector3(0.0, -0.1, 0.0);
  plate.motion.keyframes = {{.time = 0.0}, {.time = 10.0, .position = {5.0, 5.0, 0.0}}};  // 0.5 m/s sideways and up
  Simulator simulator(one_particle({0.0, 0.011, 0.0}, rough), settings(1e-3), {plate});
  run(simulator, 1.0);
  // The rising plate hits the particle at 0.5 m/s. Friction gives it mu * 0.5 m/s at once. Until it has the plate's speed, it lags
  // by u^2 / (2 mu g) with the remaining speed difference u. The impact time is uncertain by a step or two: 2 u dt. The gap closes
  // in 1 mm / 0.5 m/s.
  const double left = 0.5 - mu * 0.5;
  EXPECT_NEAR(simulator.positions()(0, 0), 0.5 - left * left / (2.0 * mu * kGravity), 1.5e-3);
  EXPECT_NEAR(simulator.positions()(1, 0), 0.51, 1e-3);
}

TEST_P(ContactSolver, NoParticleCrossesAThinSheetAtAnySpeed) {
  for (const double side : {1.0, -1.0}) {
    for (const double speed : {0.0, 5.0, 50.0, 500.0}) {
      const Obstacle obstacle = testing::sheet(1.0);
      SimulatorSettings chosen = settings(1e-3);
      chosen.gravity *= side;
      // The particle flies towards the diagonal that both triangles share.
      Simulator simulator(one_particle({0.25, side * 0.1, 0.25}, {.thickness = 0.002}, {0.0, -side * speed, 0.0}), chosen,
                          {obstacle});
      for (int i = 0; i < 400; ++i) {
        simulator.step();
        ASSERT_GT(side * simulator.positions()(1, 0), 0.0) << "speed " << speed << ", step " << i;
      }
      EXPECT_NEAR(side * simulator.positions()(1, 0), 0.002, 1.1e-5);
    }
  }
}

TEST_P(ContactSolver, ContactWorksAtThicknessZero) {
  const double mu = 0.3;
  const ContactMaterial material{.friction = mu, .static_friction = mu};
  Obstacle box{.name = "box", .geometry = BoxGeometry{.size = {20.0, 1.0, 20.0}}, .material = material};
  box.rest_pose.translation() = Vector3(0.0, -0.5, 0.0);
  for (const Obstacle& obstacle : {ground(material), box, testing::sheet(9.0, material)}) {
    Simulator simulator(one_particle({0.0, 0.001, 0.0}, material, {2.0, 0.0, 0.0}), settings(1e-3), {obstacle});
    run(simulator, 1.5);
    // The particle slides to a stop as with any other thickness. The fall of 1 mm takes 14 ms without friction. The impact of 0.14
    // m/s removes mu times that speed at once.
    const double fall = std::sqrt(2.0 * 0.001 / kGravity);
    const double speed = 2.0 - mu * kGravity * fall;
    EXPECT_NEAR(simulator.positions()(0, 0), 2.0 * fall + speed * speed / (2.0 * mu * kGravity), 2.0 * 2.0 * 1e-3) << obstacle.name;
    EXPECT_GT(simulator.positions()(1, 0), 0.0) << obstacle.name;
    EXPECT_LT(simulator.positions()(1, 0), 1e-4) << obstacle.name;
  }
}

TEST_P(ContactSolver, APenaltySupportsTheWeightAtItsStaticDepth) {
  SimulatorSettings chosen = settings(1e-4);
  chosen.contact = {.response = ContactSettings::Response::penalty, .stiffness = 1000.0, .damping = 5.0};
  chosen.inner_substeps = 1;
  Simulator simulator(one_particle({0.0, 0.02, 0.0}, {.thickness = 0.01}), chosen, {ground()});
  run(simulator, 1.0);
  // k (h - y) = m g. With c / m = 50 1/s, e^-25 of the motion remains.
  EXPECT_NEAR(simulator.positions()(1, 0), 0.01 - 0.1 * kGravity / 1000.0, 1e-9);
  EXPECT_EQ(simulator.contact_count(), 1);
}

// A velocity Verlet step conserves K + P (1 - (w dt)^2 / 4) of a harmonic motion of energy K + P, w^2 = k / m. In the two steps in
// which the particle enters and leaves the gap, it moves by at most v dt within it, where the force is not linear. Each of them
// changes the energy by at most k (v dt)^2 / 2 = K (w dt)^2.
TEST(PenaltyContact, ABounceConservesTheEnergy) {
  constexpr double kStiffness = 500.0;
  constexpr double kMass = 0.1;
  constexpr double kGap = 0.1;
  for (const Obstacle& obstacle : landing_surfaces()) {
    for (const double step : {1e-3, 1e-4}) {
      const SimulatorSettings settings{.step = step,
                                       .integrator = VelocityVerletSettings{},
                                       .contact = {.response = ContactSettings::Response::penalty, .stiffness = kStiffness}};
      Simulator simulator(one_particle({0.0, kGap + 0.2, 0.0}, {.thickness = kGap}), settings, {obstacle});
      const double start = simulator.gravity_energy();
      const double supplied = kMass * kGravity * (0.2 + kGap);
      const double tolerance = (0.25 + 2.0) * kStiffness / kMass * step * step * supplied;
      double most_stored = 0.0;
      for (int i = 0; i < std::lround(0.6 / step); ++i) {
        simulator.step();
        const double total = kinetic_energy(simulator) + simulator.gravity_energy() + simulator.contact_energy();
        ASSERT_NEAR(total, start, tolerance) << obstacle.name << ", step " << i << " of " << step;
        most_stored = std::max(most_stored, simulator.contact_energy());
      }
      // The fall of 0.2 m and the depth both feed the spring.
      EXPECT_GT(most_stored, kMass * kGravity * 0.2) << obstacle.name;
      EXPECT_GT(simulator.positions()(1, 0), kGap) << "it has left the surface";
    }
  }
}

TEST(ContactCount, CountsSupportedParticles) {
  Simulator simulator(testing::cloth(5, 0.005, {.thickness = 0.005}), {.step = 2.5e-4, .steps_per_frame = 100}, {ground()});
  FrameRunner frames(simulator);
  EXPECT_EQ(frames.next_frame().contacts, 25);
  const FrameDiagnostics frame = frames.next_frame();
  ASSERT_TRUE(frame.min_distance.has_value());
  EXPECT_NEAR(*frame.min_distance, 0.005, 1e-6);
}

}  // namespace
}  // namespace sprung
