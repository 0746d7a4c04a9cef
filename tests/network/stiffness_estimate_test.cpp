// Estimates of stiffness against the constants from which bodies are made.
#include "network/stiffness_estimate.h"

#include "network/network_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sprung {
namespace {

constexpr double kGravity = 9.81;

SpringMaterial modulus(double value) { return {.value = value, .measure = SpringMaterial::Measure::modulus}; }

StiffnessEstimate estimate(BodyShape shape, double density, const Vector3& rotation) {
  set_density(shape, density);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees(rotation);
  place(shape, pose);
  NetworkBuilder builder;
  builder.add_body("body", shape);
  const SpringNetwork network = builder.build();
  return estimate_stiffness(network, network.bodies.front(), kGravity);
}

// The rigidity counts inner particles alone: of n segments of a rope, n - 1.
TEST(StiffnessEstimate, ARopeSagsSwingsAndBendsAsItsConstantsSay) {
  const BodyShape rope =
      make_rope({.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, .particles = 101, .length = {}},
                {.structural = modulus(50.0), .bend = modulus(0.02), .bend_model = SpringMaterials::BendModel::angle});
  const StiffnessEstimate rope_estimate = estimate(rope, 0.1, {10, 20, 30});
  EXPECT_NEAR(rope_estimate.length, 2.0, 1e-12);
  EXPECT_NEAR(rope_estimate.sag, 0.1 * kGravity * 4.0 / (2.0 * 50.0), 1e-9);
  EXPECT_NEAR(rope_estimate.stretch_period, 8.0 * std::sqrt(0.1 / 50.0), 1e-9);
  EXPECT_NEAR(rope_estimate.swing_period, 2.0 * std::numbers::pi * std::sqrt(4.0 / (3.0 * kGravity)), 1e-12);
  EXPECT_NEAR(rope_estimate.overhang, 2.0 * std::cbrt(0.02 * 0.99 / (0.1 * kGravity)), 1e-9);
}

// Along its length a cloth has the modulus M + S / 2 of structural and shear springs.
TEST(StiffnessEstimate, AClothSagsAsItsModuliSayInAnyPose) {
  for (const Vector3& rotation : {Vector3(0, 0, 0), Vector3(-90, 25, 70)}) {
    const BodyShape cloth =
        make_cloth({.size = {0.5, 2.0}, .resolution = {6, 21}}, {.structural = modulus(100.0), .shear = modulus(40.0)});
    const StiffnessEstimate cloth_estimate = estimate(cloth, 0.2, rotation);
    EXPECT_NEAR(cloth_estimate.length, 2.0, 1e-9);
    EXPECT_NEAR(cloth_estimate.sag, 0.2 * kGravity * 4.0 / (2.0 * 120.0), 1e-9);
    EXPECT_EQ(cloth_estimate.overhang, 0.0);
  }
}

// The rigidity is the mean of both directions, and counts inner particles alone: of n cells along a direction, n - 1.
TEST(StiffnessEstimate, AClothBendsAsItsRigiditySays) {
  const BodyShape cloth = make_cloth({.size = {0.5, 2.0}, .resolution = {6, 21}},
                                     {.bend = modulus(0.03), .bend_model = SpringMaterials::BendModel::angle});
  const double rigidity = 0.03 * (4.0 / 5.0 + 19.0 / 20.0) / 2.0;
  EXPECT_NEAR(estimate(cloth, 0.2, {10, 20, 30}).overhang, 2.0 * std::cbrt(rigidity / (0.2 * kGravity)), 1e-9);
}

TEST(StiffnessEstimate, WithoutStiffnessTheSagIsInfinite) {
  const BodyShape rope = make_rope({.points = {{0, 0, 0}, {1, 0, 0}}, .particles = 11, .length = {}}, {.structural = modulus(0.0)});
  EXPECT_TRUE(std::isinf(estimate(rope, 0.1, {0, 0, 0}).sag));
}

}  // namespace
}  // namespace sprung
