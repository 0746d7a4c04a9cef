// The resistance of triangles to bending.
#include "base/parallel.h"
#include "dynamics/dense_matrix.h"
#include "dynamics/forces/bending_helpers.h"
#include "dynamics/forces/force_derivatives.h"
#include "dynamics/forces/hinge_angle.h"
#include "dynamics/forces/material_dampers.h"
#include "network/network_builder.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace sprung {
namespace {

using testing::expect_balanced;
using testing::expect_gradient;
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
  // The angle is 0.014, and the sides differ in its square, 2e-4.
  EXPECT_NEAR(forces(2, 1), forces(2, 3), 1e-3 * std::abs(forces(2, 1))) << "at equal heights";
}

TEST(Hinges, ForcesAreTheNegativeGradientOfTheEnergy) {
  const SpringNetwork network = network_of(tent());
  // In a box of 2 m triangles have any size; in one of 0.4 m most are smaller than at rest. Differences are off by h^2 times the
  // third derivative: at most some 1e2 k / height^3, with heights of 0.01 m.
  for (unsigned trial = 0; trial < 60; ++trial) {
    const double size = trial % 2 == 0 ? 2.0 : 0.4;
    const Points x = random_points(network.particle_count(), trial, size);
    SCOPED_TRACE(trial);
    expect_gradient(network, x, 1e-7 * size, 1e-5 * (1.0 + forces_of(network, x).norm()));
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
  // The gradient of phi is at most 1 / (half of a height at rest), twice for two triangles, and pi times as much again from f. Its
  // product with v, of 2 m/s, is the rate. The largest weight is at least the inverse of the least height.
  double steepest = 0.0;
  for (const auto& weights : network.hinges.weights) {
    for (const double weight : weights) steepest = std::max(steepest, 2.0 * std::abs(weight) * (1.0 + std::numbers::pi));
  }
  double largest = 0.0;
  for (const Matrix3& curvature : network.face_bends.curvature) {
    const double values = std::sqrt(3.0) * (std::numbers::pi + kDampingTime * steepest * 4.0 * 2.0);
    largest += 3.0 * 4.0 * steepest * kRigidity * curvature.squaredNorm() * values;
  }
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
    x.col(4) = x.col(1) + Eigen::AngleAxisd(angle, axis) * Vector3(x.col(4) - x.col(1));
    return force.energy(x);
  };
  // One angle turns. The slope of 1/2 k |F phi|^2 by it is at most k |F|^2 |phi|, with three angles of at most pi a triangle.
  double slope = 0.0;
  for (const Matrix3& curvature : network.face_bends.curvature) {
    slope += kRigidity * curvature.squaredNorm() * std::sqrt(3.0) * std::numbers::pi;
  }
  for (double angle = 0.0; angle < 2.0 * std::numbers::pi; angle += 1e-3) {
    EXPECT_NEAR(folded(angle), folded(angle + 1e-3), 1e-3 * slope);
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

TEST(Hinges, CapacityIsAtLeastAnyEnergy) {
  const SpringNetwork network = network_of(tent());
  const BendingAngleForce force(network);
  for (unsigned trial = 0; trial < 100; ++trial) {
    EXPECT_GE(force.capacity(), force.energy(random_points(network.particle_count(), trial, 1.0)));
  }
}

// Displacements along the normal of a flat mesh: the weights of the elements are then those of the derivatives.
TEST(Hinges, ElementsOfAFlatMeshAreItsDerivativesAlongTheNormal) {
  const SpringNetwork network = network_of(mesh_of((Points(3, 5) << 0, 1, 0, 1.2, 2, 0, 0, 1, 0.9, 0.2, 0, 0, 0, 0, 0).finished(),
                                                   (Triangles(3, 3) << 0, 1, 1, 1, 3, 4, 2, 2, 3).finished()),
                                           kDampingTime);
  Forces forces;
  forces.push_back(std::make_unique<BendingAngleForce>(network));
  ForceDerivatives derivatives = make_derivatives(forces, network.particle_count());
  const Points still = Points::Zero(3, network.particle_count());
  differentiate(forces, {.x = network.positions, .v = still}, derivatives);
  std::vector<LinearElement> elements;
  forces.front()->append_elements(elements);
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(5, 5);
  Eigen::MatrixXd damping = stiffness;
  for (const LinearElement& element : elements) {
    for (std::size_t i = 0; i < element.count; ++i) {
      for (std::size_t j = 0; j < element.count; ++j) {
        const double product = element.weights[i] * element.weights[j];
        stiffness(element.particles[i], element.particles[j]) += element.stiffness * product;
        damping(element.particles[i], element.particles[j]) += element.damping * product;
      }
    }
  }
  const auto along_normal = [](const BlockMatrix& matrix) {
    return Eigen::MatrixXd(dense(matrix)(Eigen::seqN(2, 5, 3), Eigen::seqN(2, 5, 3)));
  };
  const double rounding = 1e-12 * stiffness.norm();
  EXPECT_GT(stiffness.norm(), 1.0);
  EXPECT_LT((stiffness + along_normal(derivatives.by_position)).norm(), rounding);
  EXPECT_LT((damping + along_normal(derivatives.by_velocity)).norm(), rounding);
}

// The power of dampers is c |F r|^2 for the rates r of the angles, which are at most the lengths of their gradients for unit
// velocities: those at rest are the weights.
TEST(Hinges, DampersDampNoMotionFasterThanAtRest) {
  const SpringNetwork network = network_of(tent(), kDampingTime);
  ElementConstants constants = constants_of_bends(network);
  std::ranges::fill(constants.stiffness, 0.0);
  const BendingAngleForce dampers(network, constants);
  double most = 0.0;  // of the power of unit velocities
  for (Index f = 0; f < network.face_bends.count(); ++f) {
    double squares = 0.0;
    for (const Index hinge : network.face_bends.hinges[f]) {
      if (hinge == kNone) continue;
      for (const double weight : network.hinges.weights[hinge]) squares += weight * weight;
    }
    most += network.face_bends.damping[f] * network.face_bends.curvature[f].squaredNorm() * squares;
  }
  for (unsigned trial = 0; trial < 100; ++trial) {
    const Points x = random_points(network.particle_count(), trial, trial % 2 == 0 ? 2.0 : 0.2);
    Points v = random_points(network.particle_count(), 200 + trial, 1.0);
    v /= v.norm();
    Points forces = Points::Zero(3, network.particle_count());
    dampers.add({.x = x, .v = v}, forces);
    const double power = -forces.cwiseProduct(v).sum();
    EXPECT_GE(power, 0.0);
    EXPECT_LE(power, most);
  }
}

// The springs allow a step of 2 / omega, and bends need another one only if their dampers are fast for it.
TEST(Hinges, DampersOfAMaterialActApartOnlyIfTheyAreFastForTheSprings) {
  for (const bool fast : {false, true}) {
    SpringNetwork network = network_of(tent(), fast ? 1.0 : 1e-6);
    for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {2, 0}}) {
      network.springs.append(a, b, 1.0, 1e3, 0.0, SpringKind::structural);
      ++network.bodies[0].spring_count;
    }
    network.bodies[0].has_material_dampers.fill(true);
    int apart = 0;
    for_material_bends(network, [&](Index) { ++apart; });
    EXPECT_EQ(apart, fast ? network.face_bends.count() : 0);
    const ElementConstants within = bends_without_material_dampers(network);
    EXPECT_EQ(within.damping[0] > 0.0, !fast);
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

TEST(Hinges, HaveTheSameBitsAtHeldPositions) {
  const SpringNetwork sheet = large_sheet();
  BendingAngleForce held(sheet);
  for (unsigned trial = 0; trial < 4; ++trial) {
    const Points x = sheet.positions + random_points(sheet.particle_count(), trial / 2, 0.003);
    const Points v = random_points(sheet.particle_count(), 10 + trial, 1.0);
    if (trial % 2 == 0) held.hold(x);
    Points forces = Points::Zero(3, sheet.particle_count());
    held.add({.x = x, .v = v}, forces);
    EXPECT_EQ(forces, forces_of(sheet, x, v)) << trial;
  }
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
