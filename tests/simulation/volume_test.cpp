// Solids keep their volume, and gas and water fill closed meshes.
#include "geometry/mesh/triangle_mesh.h"
#include "simulation/scenes.h"
#include "simulation/step/step_check.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sprung {
namespace {

using namespace testing;

/// A soft cube of 0.2 m, 5 mm above the ground.
SpringNetwork jelly(bool preserve) {
  SpringMaterials materials;
  materials.structural = SpringMaterial{.value = 3000.0, .measure = SpringMaterial::Measure::modulus, .damping_time = 0.003};
  materials.shear = SpringMaterial{.value = 1500.0, .measure = SpringMaterial::Measure::modulus, .damping_time = 0.003};
  BodyShape shape = make_solid({.size = {0.2, 0.2, 0.2}, .resolution = {9, 9, 9}}, materials);
  set_density(shape, 1000.0);
  shape.preserve_volume = preserve;
  place(shape, RigidTransform(Eigen::Translation3d(0.0, 0.105, 0.0)));
  NetworkBuilder builder;
  builder.add_body("jelly", shape, {.thickness = 0.002, .friction = 0.3, .static_friction = 0.3});
  return builder.build();
}

Simulator simulator_of(const SpringNetwork& network, std::vector<Obstacle> obstacles) {
  SimulatorSettings settings;
  settings.integrator = SymplecticEulerSettings{};
  settings.step = 1.0 / 60.0;
  while (settings.step > advised_step(settings.integrator, simulation_bounds(network, settings, true))) settings.step /= 2.0;
  return Simulator(network, settings, std::move(obstacles));
}

double volume_of(const Simulator& simulator) { return total_volume(simulator.network().bodies[0].cells, simulator.positions()); }

void run(Simulator& simulator, double seconds) {
  const double end = simulator.time() + seconds;
  while (simulator.time() < end - 0.5 * simulator.settings().step) simulator.step();
}

TEST(Volume, OfAJellyOnTheGroundIsKeptWithinTwoPercent) {
  Simulator kept = simulator_of(jelly(true), {ground()});
  Simulator free = simulator_of(jelly(false), {ground()});
  run(free, 1.0);
  double largest = 0.0;
  for (int tenth = 0; tenth < 10; ++tenth) {
    run(kept, 0.1);
    largest = std::max(largest, std::abs(volume_of(kept) / 0.008 - 1.0));
    EXPECT_EQ(count_inverted(kept.network().bodies[0].cells, kept.positions()), 0);
  }
  EXPECT_LT(largest, 0.02);
  EXPECT_LT(volume_of(free), 0.9 * 0.008) << "without the constraint its own weight presses it together";
}

TEST(Volume, OfASqueezedJellyIsKeptAndItBulges) {
  const auto plate = [](const char* name, double side) {
    Obstacle obstacle{.name = name, .geometry = BoxGeometry{.size = {1.0, 0.1, 1.0}}};
    obstacle.rest_pose = RigidTransform(Eigen::Translation3d(0.0, 0.105 + side * (0.1 + 0.05 + 0.005), 0.0));
    // From a height of 0.21 m between the plates to 0.104 m, half of the cube and twice the thickness of 2 mm.
    obstacle.motion.keyframes = {{.time = 0.0}, {.time = 1.0, .position = {0.0, -side * 0.053, 0.0}}};
    return obstacle;
  };
  Simulator simulator = simulator_of(jelly(true), {plate("below", -1.0), plate("above", 1.0)});
  for (int tenth = 0; tenth < 12; ++tenth) {
    run(simulator, 0.1);
    EXPECT_NEAR(volume_of(simulator) / 0.008, 1.0, 0.05) << simulator.time();
    EXPECT_EQ(count_inverted(simulator.network().bodies[0].cells, simulator.positions()), 0);
  }
  const Vector3 size = simulator.positions().rowwise().maxCoeff() - simulator.positions().rowwise().minCoeff();
  EXPECT_LT(size.y(), 0.104);
  // A block of half the height has sqrt(2) times the width, and its sides are convex.
  EXPECT_GT(size.x(), 0.95 * std::sqrt(2.0) * 0.2);
  EXPECT_GT(size.z(), 0.95 * std::sqrt(2.0) * 0.2);
}

constexpr double kMembrane = 100.0;  // [N/m]
constexpr double kRadius = 0.1;      // [m]

Simulator balloon(double pressure, double factor) {
  const TriangleMesh sphere = obstacle_mesh(SphereGeometry{.radius = kRadius}, 0.0);
  SpringMaterials materials;
  materials.structural = SpringMaterial{.value = kMembrane, .measure = SpringMaterial::Measure::modulus};
  BodyShape shape = make_mesh_body({sphere.vertices, to_polygons(sphere.triangles), Edges(2, 0)}, materials);
  set_density(shape, 0.1);
  shape.pressure = pressure;
  shape.volume_factor = factor;
  NetworkBuilder builder;
  builder.add_body("balloon", shape);
  SimulatorSettings settings;
  settings.gravity = Vector3::Zero();
  settings.integrator = VerletSettings{.damping_rate = 60.0};
  const SpringNetwork network = builder.build();
  settings.step = advised_step(settings.integrator, simulation_bounds(network, settings, false));
  return Simulator(network, settings);
}

struct Surface {
  double area = 0.0;
  double volume = 0.0;
};

Surface surface_of(const Points& positions, const Triangles& triangles) {
  Surface surface{.volume = signed_volume(positions, triangles)};
  const TriangleMesh mesh{positions, triangles};
  for (Index t = 0; t < triangles.cols(); ++t) surface.area += 0.5 * area_normal(mesh, t).norm();
  return surface;
}

// The gas does the work p dV, which the membrane's tension T takes up as T dA. A surface that grows alike everywhere has dA / dV =
// 2 A / (3 V), so p = 2 T / R with R = 3 V / A, as of a sphere. The tension is the modulus times the strain.
TEST(Volume, ABalloonInEquilibriumHasThePressureOfItsTension) {
  Simulator simulator = balloon(200.0, 0.0);
  const Triangles& triangles = simulator.network().bodies[0].surface.triangles;
  const Surface before = surface_of(simulator.positions(), triangles);
  run(simulator, 1.0);
  EXPECT_LT(simulator.state().v.cwiseAbs().maxCoeff(), 1.0e-3);
  const Surface after = surface_of(simulator.positions(), triangles);
  const double strain = std::cbrt(after.volume / before.volume) - 1.0;
  EXPECT_GT(strain, 0.1);
  EXPECT_NEAR(kMembrane * strain * 2.0 * after.area / (3.0 * after.volume), 200.0, 0.01 * 200.0);
}

TEST(Volume, ABagOfWaterKeepsItsFactor) {
  Simulator simulator = balloon(0.0, 1.3);
  const Triangles& triangles = simulator.network().bodies[0].surface.triangles;
  const double before = surface_of(simulator.positions(), triangles).volume;
  run(simulator, 0.5);
  EXPECT_NEAR(surface_of(simulator.positions(), triangles).volume, 1.3 * before, 0.002 * before);
}

}  // namespace
}  // namespace sprung
