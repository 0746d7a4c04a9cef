// The resistance of triangles to bending.
#include "base/parallel.h"
#include "dynamics/dense_matrix.h"
#include "dynamics/forces/bending_helpers.h"
#include "dynamics/forces/hinge_angle.h"
#include "network/network_builder.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace sprung {
namespace {

using testing::expect_balanced;
using testing::forces_of;
using testing::random_points;

constexpr double kRigidity = 3.0;
constexpr double kDampingTime = 0.2;

SpringNetwork network_of(const PolygonMesh& mesh, double damping_time = 0.0) {
  const SpringMaterial bend{.value = kRigidity, .measure = SpringMaterial::Measure::modulus, .damping_time = damping_time};
  BodyShape shape = make_mesh_body(mesh, {.bend = bend, .bend_model = SpringMaterials::BendModel::angle}, {});
  set_total_mass(shape, 0.5);
  NetworkBuilder builder;
  builder.add_body("mesh", shape);
  return builder.build();
}

PolygonMesh mesh_of(Points vertices, const Triangles& triangles) {
  PolygonMesh mesh;
  mesh.vertices = std::move(vertices);
  mesh.faces = to_polygons(triangles);
  return mesh;
}

/// A tetrahedron without its floor and a wing: triangles that are not in one plane at rest.
PolygonMesh tent() {
  return mesh_of((Points(3, 5) << 0, 1, 0, 0.2, 2, 0, 0, 1, 0.3, 1, 0, 0, 0, 1, 0.5).finished(),
                 (Triangles(3, 4) << 0, 1, 2, 1, 1, 2, 0, 4, 3, 3, 3, 2).finished());
}

TEST(Hinges, RestWhereTheMeshIs) {
  const SpringNetwork network = network_of(tent(), kDampingTime);
  EXPECT_GT(network.face_bends.count(), 2);
  EXPECT_LT(forces_of(network, network.positions).norm(), 1e-14);
  EXPECT_LT(BendingAngleForce(network).energy(network.positions), 1e-28);
}

// A square of two triangles, one corner of which is lifted.
TEST(Hinges, PullTowardsTheAngleAtRest) {
  const SpringNetwork network = network_of(
      mesh_of((Points(3, 4) << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0).finished(), (Triangles(3, 2) << 0, 0, 1, 2, 2, 3).finished()));
  Points x = network.positions;
  x(2, 1) = 0.01;
  const Points forces = forces_of(network, x);
  EXPECT_LT(forces(2, 1), 0.0) << "down again";
  EXPECT_LT(forces(2, 3), 0.0) << "the other triangle follows";
  EXPECT_GT(forces(2, 0), 0.0);
  EXPECT_NEAR(forces(2, 1), forces(2, 3), 1e-3 * std::abs(forces(2, 1))) << "at equal heights";
}

TEST(Hinges, ForcesAreTheNegativeGradientOfTheEnergy) {
  const SpringNetwork network = network_of(tent());
  const BendingAngleForce force(network);
  // In a box of 2 m triangles have any size; in one of 0.4 m most are smaller than half of their size at rest.
  for (unsigned trial = 0; trial < 60; ++trial) {
    const double size = trial % 2 == 0 ? 2.0 : 0.4;
    const Points x = random_points(network.particle_count(), trial, size);
    const Points forces = forces_of(network, x);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      // Central differences are off by h^2 times the third derivative: at most some 1e2 k / height^3, with heights of 0.01 m.
      const double h = 1e-7 * size;
      Points there = x;
      Points back = x;
      there(i) += h;
      back(i) -= h;
      const double slope = (force.energy(there) - force.energy(back)) / (2.0 * h);
      EXPECT_NEAR(forces(i), -slope, 1e-5 * (1.0 + forces.norm())) << "trial " << trial << ", coordinate " << i;
    }
  }
}

TEST(Hinges, HaveNoNetForceAndNoNetTorque) {
  const SpringNetwork network = network_of(tent(), kDampingTime);
  for (unsigned trial = 0; trial < 20; ++trial) {
    const Points x = random_points(network.particle_count(), trial, 1.0);
    expect_balanced(x, forces_of(network, x, random_points(network.particle_count(), 100 + trial, 1.0)));
  }
}

TEST(Hinges, RigidMotionsCostNothing) {
  const SpringNetwork network = network_of(tent(), kDampingTime);
  const Points x = network.positions + random_points(network.particle_count(), 1, 0.2);
  const Eigen::Matrix3d turn = rotation_from_degrees({20, 50, -70});
  const Points turned = (turn * x).colwise() + Vector3(3, -2, 1);
  EXPECT_NEAR(BendingAngleForce(network).energy(turned), BendingAngleForce(network).energy(x), 1e-12);
  EXPECT_LT((forces_of(network, turned) - turn * forces_of(network, x)).norm(), 1e-11);
  const Vector3 omega(0.3, -1.0, 2.0);
  Points v(3, x.cols());
  for (Index i = 0; i < x.cols(); ++i) v.col(i) = omega.cross(Vector3(x.col(i))) + Vector3(1, 1, 4);
  EXPECT_LT((forces_of(network, x, v) - forces_of(network, x)).norm(), 1e-11);
}

TEST(Hinges, DampersOnlyTakeEnergy) {
  const SpringNetwork damped = network_of(tent(), kDampingTime);
  const SpringNetwork undamped = network_of(tent());
  for (unsigned trial = 0; trial < 20; ++trial) {
    const Points x = random_points(damped.particle_count(), trial, trial % 2 == 0 ? 1.0 : 0.3);
    const Points v = random_points(damped.particle_count(), 50 + trial, 1.0);
    EXPECT_LT((forces_of(damped, x, v) - forces_of(undamped, x, v)).cwiseProduct(v).sum(), 0.0);
  }
}

TEST(Hinges, FoldedAndCollapsedTrianglesHaveFiniteForces) {
  const SpringNetwork network = network_of(tent(), kDampingTime);
  const Points v = random_points(network.particle_count(), 9, 1.0);
  std::vector<Points> states{Points::Zero(3, 5), 1e-12 * network.positions, 1e-200 * network.positions, network.positions};
  states[3].col(4) = states[3].col(3);  // folded onto each other
  for (Index i = 0; i < 5; ++i) {
    states.push_back(network.positions);
    states.back().col(i) = states.back().col((i + 1) % 5);  // a side without length
  }
  // A height of the mesh at rest is at least 0.4 m; each hinge turns by at most pi against at most 40 k, and as much again from f.
  const double largest = 1e4 * kRigidity * std::numbers::pi;
  for (const Points& x : states) {
    const Points forces = forces_of(network, x, v);
    EXPECT_TRUE(forces.allFinite()) << x;
    EXPECT_LT(forces.norm(), largest) << x;
    EXPECT_TRUE(std::isfinite(BendingAngleForce(network).energy(x))) << x;
  }
}

TEST(Hinges, AFoldThroughHalfATurnHasNoJumpOfEnergy) {
  const SpringNetwork network = network_of(tent());
  const BendingAngleForce force(network);
  const auto folded = [&](double angle) {
    Points x = network.positions;
    const Vector3 axis = (x.col(2) - x.col(1)).normalized();
    for (const Index i : {Index{4}}) x.col(i) = x.col(1) + Eigen::AngleAxisd(angle, axis) * Vector3(x.col(i) - x.col(1));
    return force.energy(x);
  };
  for (double angle = 0.0; angle < 2.0 * std::numbers::pi; angle += 1e-3) {
    // The slope of the energy is at most k |F|^2 pi, with |F|^2 below 50 for these triangles.
    EXPECT_NEAR(folded(angle), folded(angle + 1e-3), 1e-3 * 50.0 * kRigidity * std::numbers::pi);
  }
}

// Around the state at rest, where the moments are 0, the derivatives have no other term.
TEST(Hinges, DerivativesAtRestAreTheDifferencesOfTheForces) {
  const SpringNetwork network = network_of(tent(), kDampingTime);
  Forces forces;
  forces.push_back(std::make_unique<BendingAngleForce>(network));
  const Points& x = network.positions;
  const Points still = Points::Zero(3, x.cols());
  ForceDerivatives derivatives = make_derivatives(forces, static_cast<Index>(x.cols()));
  differentiate(forces, {.x = x, .v = still}, derivatives);
  const double h = 1e-6;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    Points moved = Points::Zero(3, x.cols());
    moved(k) = h;
    const Points by_position = (forces_of(network, x + moved) - forces_of(network, x - moved)) / (2.0 * h);
    const Points by_velocity = (forces_of(network, x, moved) - forces_of(network, x, -moved)) / (2.0 * h);
    // Differences are off by h times the second derivative and by the rounding of forces of 1e2 by h.
    EXPECT_LT((dense(derivatives.by_position).col(k) - by_position.reshaped()).norm(), 1e-4);
    EXPECT_LT((dense(derivatives.by_velocity).col(k) - by_velocity.reshaped()).norm(), 1e-6);
  }
}

/// A sheet of more particles than one thread takes at a time.
SpringNetwork large_sheet() {
  const Index side = 70;
  Points vertices(3, side * side);
  Triangles triangles(3, 2 * (side - 1) * (side - 1));
  for (Index i = 0; i < side * side; ++i) vertices.col(i) = 0.01 * Vector3(i % side, i / side, 0.0);
  Index t = 0;
  for (Index j = 0; j + 1 < side; ++j) {
    for (Index i = 0; i + 1 < side; ++i) {
      const Index a = j * side + i;
      triangles.col(t++) << a, a + 1, a + side + 1;
      triangles.col(t++) << a, a + side + 1, a + side;
    }
  }
  return network_of(mesh_of(vertices, triangles), kDampingTime);
}

TEST(Hinges, HaveTheSameBitsForAnyNumberOfThreads) {
  const SpringNetwork sheet = large_sheet();
  const Points x = sheet.positions + random_points(sheet.particle_count(), 3, 0.003);
  const Points v = random_points(sheet.particle_count(), 4, 1.0);
  const Points forces = forces_of(sheet, x, v);
  const ThreadLimit one(1);
  EXPECT_EQ(forces_of(sheet, x, v), forces);
  EXPECT_GT(forces.norm(), 0.0);
}

}  // namespace
}  // namespace sprung
