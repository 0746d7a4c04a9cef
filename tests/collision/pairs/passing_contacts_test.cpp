// Contacts between bodies that move far in a step, through each other or past each other.
#include "collision/self_networks.h"

#include <gtest/gtest.h>

#include <random>

namespace sprung {
namespace {

using test::SelfNetwork;

constexpr double kEdge = 0.02;  // [m]
constexpr double kGap = 0.01;   // [m]

struct Step {
  SelfNetwork network;
  Points after;
  std::vector<Contact> contacts{};
};

/// A sheet and a rotated one above it, at least `height` [m] away, which moves by `displacement` [m].
Step step_of_sheets(const Eigen::Quaterniond& rotation, double height, const Vector3& displacement) {
  Step step;
  step.network.add_cloth(12, {-6.0 * kEdge, 0.0, -6.0 * kEdge}, kEdge * Vector3::UnitX(), kEdge * Vector3::UnitZ());
  const Index below = step.network.count();
  const Vector3 u = rotation * Vector3(0.7 * kEdge, 0.0, 0.0);
  const Vector3 v = rotation * Vector3(0.0, 0.0, 0.7 * kEdge);
  step.network.add_cloth(4, -2.0 * (u + v), u, v);
  Points& x = step.network.positions;
  x.rightCols(x.cols() - below).row(1).array() += height - x.rightCols(x.cols() - below).row(1).minCoeff();
  step.after = x;
  step.after.rightCols(x.cols() - below).colwise() += displacement;
  const CollisionSurface surface = step.network.surface(kGap);
  PairSeparation pairs(surface, x, 0.5 * kGap);
  pairs.begin_step(x, step.after, step.contacts);
  return step;
}

double height(const Contact& contact, const Points& x) {
  double sum = 0.0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
    sum += contact.weights[k] * contact.normal.dot(x.col(contact.particles[k]));
  }
  return sum;
}

TEST(PassingContacts, OfBodiesThatWouldCrossFaceTheSideTheyCameFrom) {
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  int through = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Quaterniond rotation(
        Eigen::AngleAxisd(0.5 * number(engine), Vector3(number(engine), 1.0, number(engine)).normalized()));
    const Vector3 displacement(3.0 * kGap * number(engine), -(3.0 + number(engine)) * kGap, 3.0 * kGap * number(engine));
    const Step step = step_of_sheets(rotation, (1.2 + 0.2 * number(engine)) * kGap, displacement);
    for (const Contact& contact : step.contacts) {
      through += height(contact, step.after) < 0.0 ? 1 : 0;
      EXPECT_GT(height(contact, step.network.positions), 0.0) << "trial " << trial;
    }
  }
  EXPECT_GT(through, 2000);
}

// With displacements of more than 2.5 gaps a step some contacts are within the gap, measured along an oblique normal.
TEST(PassingContacts, OfBodiesThatPassBeyondTheGapAreFartherThanTheGap) {
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(0.23, Vector3::UnitY()));
  for (double gaps = 0.25; gaps <= 2.5; gaps += 0.25) {
    const Step step = step_of_sheets(rotation, 1.2 * kGap, Vector3(gaps * kGap, 0.0, 0.1 * gaps * kGap));
    for (const Contact& contact : step.contacts) EXPECT_GE(contact.distance, kGap) << gaps << " gaps a step";
  }
}

}  // namespace
}  // namespace sprung
