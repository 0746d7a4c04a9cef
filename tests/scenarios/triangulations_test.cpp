// Meshes of a material bend alike however they are triangulated.
#include "base/scratch_folder.h"
#include "geometry/mesh/triangle_mesh.h"
#include "network/network_builder.h"
#include "scenarios/mesh_samples.h"
#include "scenarios/scenario.h"
#include "simulation/scenes.h"
#include "simulation/simulator.h"
#include "simulation/step/step_check.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <vector>

namespace sprung {
namespace {

SpringMaterial modulus(double value) { return {.value = value, .measure = SpringMaterial::Measure::modulus}; }

/// Pins the particles that satisfy `is_clamped` and runs.
Points at_rest(const BodyShape& shape, const std::function<bool(const Vector3&)>& is_clamped, SimulatorSettings settings,
               double damping_rate, double seconds) {
  NetworkBuilder builder;
  builder.add_body("sheet", shape, {}, {.self = false, .others = false});
  std::vector<Index> clamped;
  for (std::size_t i = 0; i < shape.positions.size(); ++i) {
    if (is_clamped(shape.positions[i])) clamped.push_back(static_cast<Index>(i));
  }
  builder.pin(clamped);
  const SpringNetwork network = builder.build();
  settings.integrator = VerletSettings{.damping_rate = damping_rate};
  settings.step = advised_step(settings.integrator, simulation_bounds(network, settings, false));
  Simulator simulator(network, settings);
  while (simulator.time() < seconds) simulator.step();
  return simulator.positions();
}

// A strip of 1 m with D for a deflection of 1 cm. See beam_test.cpp for its time, and for the clamp half-way between two columns.
TEST(Triangulations, AStripDeflectsAsAPlate) {
  const double density = 0.1;
  const double bending = density * testing::kGravity / (8.0 * 0.01);
  const double side = 0.1;
  for (const testing::Pattern pattern : testing::kPatterns) {
    BodyShape strip = make_mesh_body(
        testing::sheet(pattern, {11, 3}, side, [](const Vector3&) { return true; }),
        {.structural = modulus(1e3 * bending), .bend = modulus(bending), .bend_model = SpringMaterials::BendModel::angle}, {});
    set_density(strip, density);
    const Points x = at_rest(
        strip, [&](const Vector3& at) { return at.x() < 1.01 * side; }, {}, 78.0, 0.5);
    const double length = 10.5 * side;
    const double expected = density * testing::kGravity * std::pow(length, 4) / (8.0 * bending);
    EXPECT_NEAR(-x.row(1).minCoeff(), expected, 0.2 * expected) << testing::name_of(pattern);
  }
}

// Two particles of four triangles are moved through each other and let go. Bends as stiff as these springs fold and squeeze
// triangles as far as any crumpling does. Nothing drives the body from then on; the energy of velocity Verlet wavers by the square
// of its step.
TEST(Triangulations, ACrumpledSheetKeepsItsEnergy) {
  const testing::ScratchFolder folder;
  std::ofstream(folder / "sheet.obj") << "v 0 0 0\nv .02 0 0\nv 0 .02 0\nv .02 .02 0\nv 0 .04 0\nv .02 .04 0\n"
                                         "f 1 2 3\nf 2 4 3\nf 3 4 6\nf 3 6 5\n";
  std::ofstream(folder / "sheet.json") << R"({"duration": 2, "gravity": [0, 0, 0], "sleep": false,
      "integrator": {"type": "velocity_verlet"}, "bodies": {"sheet": {"shape": {"type": "mesh", "file": "sheet.obj"}, "density": 0.2,
      "springs": {"structural": {"modulus": 200}, "bend": {"model": "angle", "modulus": 0.03}}, "pins": [{"indices": [0],
      "until": 0.4, "motion": {"keyframes": [{"time": 0}, {"time": 0.4, "position": [0.03, 0.03, 0.02]}]}},
      {"indices": [5], "until": 0.4}]}}})";
  const BuiltScene scene = testing::load_scenario((folder / "sheet").string());
  Simulator simulator(scene.network, scene.settings, scene.obstacles);
  const auto energy = [&] { return kinetic_energy(simulator) + simulator.elastic_energy(); };
  while (simulator.time() < 0.43) simulator.step();
  const double begin = energy();
  while (simulator.time() < 2.0) {
    simulator.step();
    ASSERT_NEAR(energy(), begin, 0.2 * begin) << "at " << simulator.time() << " s";
  }
}

// The walls of 10 cm are as stiff as a sheet of paper; a box of limp triangles of the same springs lies flat at once.
TEST(Triangulations, APaperCartonStands) {
  const testing::ScratchFolder folder;
  const PolygonMesh box = testing::box_of_quads(Vector3::Constant(0.1), {10, 10, 10});
  std::ofstream(folder / "box.obj") << obj_text(box.vertices, box.faces, box.lines);
  std::ofstream(folder / "carton.json") << R"({"duration": 3, "bodies": {"carton": {"shape": {"type": "mesh", "file": "box.obj"},
      "material": "paper", "place": {"position": [0, 0.06, 0]}}}, "obstacles": {"floor": {"shape": {"type": "half_space"}}}})";
  const BuiltScene scene = testing::load_scenario((folder / "carton").string());
  EXPECT_LT(1.0 / 30.0 / scene.settings.step, 200.0) << "steps a frame";
  Simulator simulator(scene.network, scene.settings, scene.obstacles);
  while (simulator.time() < 3.0) simulator.step();
  const Triangles& triangles = scene.network.bodies[0].surface.triangles;
  EXPECT_GT(signed_volume(simulator.positions(), triangles), 0.98 * signed_volume(scene.network.positions, triangles));
}

}  // namespace
}  // namespace sprung
