// Surfaces that cells carry: the surface is judged, not the cells.
#include "base/scratch_folder.h"
#include "geometry/mesh/polygon_mesh.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scenarios/mesh_samples.h"
#include "scenarios/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

namespace sprung::testing {
namespace {

class LatticeScenario : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(StepFactor, LatticeScenario, ::testing::Values(1.0, 4.0));

TEST_P(LatticeScenario, ABallFallsOnASpike) {
  const ScenarioReport report = run_scenario(load_stiff_scenario("lattice_on_spike", GetParam()));
  EXPECT_TRUE(report.is_free()) << report;
  EXPECT_EQ(report.infeasible, 0);
}

TEST_P(LatticeScenario, ABallIsThrownAtASpike) {
  const char* const thrown = "bodies.ball.velocity=[0, -20, 0]";
  const ScenarioReport report = run_scenario(load_scenario("lattice_on_spike", {thrown, "duration=0.3"}, 1.0 / GetParam()));
  EXPECT_TRUE(report.is_free()) << report;
}

// Corners of cells lie outside of the ball, and so below the ground when the ball lies on it.
TEST(LatticeAtRest, ItsSurfaceLiesOnTheGroundAndItsCellsDoNotCollide) {
  const char* const ground = R"(obstacles={"ground": {"shape": {"type": "half_space"}, "friction": 0.3}})";
  const char* const low = R"(bodies.ball.place={"position": [0, 0.16, 0], "rotation": [45, 0, 45]})";
  for (const char* const contact :
       {R"(contact={"response": "projection"})", R"(contact={"response": "penalty", "stiffness": 500, "damping": 1})"}) {
    const BuiltScene scene = load_scenario("lattice_on_spike", {ground, low, contact});
    Simulator simulator(scene.network, scene.settings, scene.obstacles);
    EXPECT_THAT(simulator.warnings(), ::testing::Each(::testing::HasSubstr("static_friction has no effect with penalty contact")));
    const Body& ball = simulator.network().bodies[0];
    while (simulator.time() < 1.0) simulator.step();
    const auto vertices = simulator.positions().leftCols(ball.contact_vertex_count());
    const auto corners = simulator.positions().rightCols(ball.particle_count - ball.contact_vertex_count());
    EXPECT_LT(vertices.row(1).minCoeff(), 1.1 * ball.material.thickness) << "on the ground, at the thickness or below it";
    EXPECT_LT(corners.row(1).minCoeff(), 0.0) << "a cell is 0.05 m wide";
    EXPECT_GT(simulator.contact_count(), 0);
    EXPECT_LT(simulator.contact_particles().back(), ball.contact_vertex_count());
  }
}

// A surface that moved alone would be pulled back by its cells at once, with tens of joules.
TEST(LatticeAtTheStart, PushOutMovesItAsAWhole) {
  const char* const ground = R"(obstacles={"ground": {"shape": {"type": "half_space"}, "friction": 0.3}})";
  const BuiltScene scene = load_scenario(
      "lattice_on_spike", {ground, R"(bodies.ball.place={"position": [0, 0.05, 0]})", R"(contact={"start": "push_out"})"});
  Simulator simulator(scene.network, scene.settings, scene.obstacles);
  const Points moved = simulator.positions() - scene.network.positions;
  EXPECT_GT(moved(1, 0), 0.1);
  EXPECT_LT((moved.colwise() - moved.col(0)).cwiseAbs().maxCoeff(), 1.0e-12);
  const double weight = scene.network.masses.sum() * 9.81;
  simulator.step();
  EXPECT_LT(kinetic_energy(simulator), weight * 1.0e-3) << "less than from a fall by a millimetre";
}

// The spike moves up by 1.5 m at 15 m/s.
TEST_P(LatticeScenario, ASpikeIsShotAtABall) {
  const char* const shot = R"(obstacles.spike.motion={"keyframes": [{"time": 0}, {"time": 0.1, "position": [0, 1.5, 0]}]})";
  const ScenarioReport report = run_scenario(load_scenario("lattice_on_spike", {shot, "duration=0.3"}, 1.0 / GetParam()));
  EXPECT_TRUE(report.is_free()) << report;
}

/// A box that has come to rest on a floor.
struct RestingBox {
  double sag = 0.0;     ///< of its height at the corners [m]
  double volume = 0.0;  ///< of its volume at first
  Index inverted = 0;   ///< cells
};

RestingBox rest_on_floor(const PolygonMesh& box, Index cells, const std::string& material) {
  const ScratchFolder folder;
  std::ofstream(folder / "box.obj") << obj_text(box.vertices, box.faces, box.lines);
  const double height_of_centre = box.vertices.row(1).maxCoeff() + 0.002;  // on its thickness
  std::ofstream(folder / "box.json") << R"({"duration": 1, "sleep": false, "integrator": {"type": "verlet", "damping_rate": 10},
      "bodies": {"box": {"shape": {"type": "lattice", "file": "box.obj", "cells": )"
                                     << cells << R"(}, "material": ")" << material << R"(", "place": {"position": [0, )"
                                     << height_of_centre << R"(, 0]}}},
      "obstacles": {"floor": {"shape": {"type": "half_space"}, "friction": 0.5}}})";
  const BuiltScene scene = load_scenario((folder / "box").string());
  Simulator simulator(scene.network, scene.settings, scene.obstacles);
  while (simulator.time() < 1.0) simulator.step();
  const Body& body = simulator.network().bodies[0];
  const auto height = [&](const Points& vertices) {
    const Vector3 corner = box.vertices.rowwise().maxCoeff();
    double sum = 0.0;
    for (Index v = 0; v < box.vertices.cols(); ++v) {
      if (box.vertices.col(v).cwiseAbs() == corner) sum += std::copysign(0.25, box.vertices(1, v)) * vertices(1, v);
    }
    return sum;
  };
  const auto volume = [&](const Points& vertices) { return signed_volume(vertices, body.surface.triangles); };
  const Points first = scene.network.positions.leftCols(body.contact_vertex_count());
  const Points last = simulator.positions().leftCols(body.contact_vertex_count());
  return {.sag = height(first) - height(last),
          .volume = volume(last) / volume(first),
          .inverted = count_inverted(body.cells, simulator.positions())};
}

// Friction at the floor makes a cube stiffer than rho g H^2 / (2 E) says, so that the finest mesh is the measure.
TEST(CoarseLattice, ACubeSagsAndRestsLikeOneOfAFineMesh) {
  constexpr double kSide = 0.2;
  for (const char* material : {"soft_jelly", "firm_jelly"}) {
    std::vector<RestingBox> cubes;
    for (const Index quads : {8, 4, 2, 1}) {
      cubes.push_back(rest_on_floor(box_of_quads(Vector3::Constant(kSide), {quads, quads, quads}), 8, material));
      EXPECT_NEAR(cubes.back().sag, cubes.front().sag, 0.1 * cubes.front().sag) << material << " " << quads;
      EXPECT_NEAR(cubes.back().volume, 1.0, 0.01) << material << " " << quads;
      EXPECT_EQ(cubes.back().inverted, 0) << material << " " << quads;
    }
  }
}

// E as measured on gels and foams (material_table.cpp). A column of three cells across, twice as high as wide, leans on friction at
// its foot and is softer at its corners, by a few percent each.
TEST(CoarseLattice, AColumnSagsByItsWeightAndYoungsModulus) {
  struct Solid {
    const char* material;
    double young;    // [Pa]
    double density;  // [kg/m^3]
  };
  for (const auto& [material, young, density] : {Solid{"firm_jelly", 53.0e3, 1060.0}, Solid{"foam", 3.0e5, 30.0}}) {
    constexpr double kHeight = 0.3;
    const RestingBox column = rest_on_floor(box_of_quads({kHeight / 2.0, kHeight, kHeight / 2.0}, {1, 1, 1}), 6, material);
    const double law = density * 9.81 * kHeight * kHeight / (2.0 * young);
    EXPECT_NEAR(column.sag, law, 0.1 * law) << material;
    EXPECT_EQ(column.inverted, 0) << material;
  }
}

}  // namespace
}  // namespace sprung::testing
