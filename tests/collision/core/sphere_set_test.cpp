#include "collision/core/sphere_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace sprung {
namespace {

using ::testing::ElementsAre;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Particles on a line, two of which no ball is for, and the way into a frame that is turned and shifted.
class BallsOfFiveParticles : public ::testing::Test {
 protected:
  BallsOfFiveParticles() : into_(Eigen::Translation3d(1.0, 2.0, 3.0) * Eigen::AngleAxisd(0.5, Vector3(1.0, 2.0, 2.0) / 3.0)) {
    for (Index i = 0; i < positions_.cols(); ++i) positions_.col(i) = Vector3(i, 0.0, 0.0);
    for (Index ball = 0; ball < 5; ++ball) balls_.set(ball, into_ * Vector3(positions_.col(particles_[at(ball)])), 1.0);
  }

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  std::vector<Index> outside(double margin) const {
    std::vector<Index> found{7};
    balls_.find_outside({positions_, particles_, into_}, margin, found);
    return found;
  }

  Points positions_{3, 7};
  std::vector<Index> particles_{6, 1, 5, 2, 3};
  RigidTransform into_;
  SphereSet balls_{5};
};

TEST_F(BallsOfFiveParticles, HoldParticlesThatStay) { EXPECT_THAT(outside(0.0), ElementsAre()); }

TEST_F(BallsOfFiveParticles, DoNotHoldThoseThatMovedByTheRadius) {
  positions_.col(5) += Vector3(0.0, 1.01, 0.0);
  positions_.col(3) += Vector3(0.0, 0.0, -1.01);
  positions_.col(1) += Vector3(0.0, 0.99, 0.0);
  positions_.col(0) += Vector3(9.0, 9.0, 9.0);
  EXPECT_THAT(outside(0.0), ElementsAre(2, 4));
}

TEST_F(BallsOfFiveParticles, AMarginIsTakenFromTheRadius) {
  positions_.col(1) += Vector3(0.0, 0.5, 0.0);
  EXPECT_THAT(outside(0.49), ElementsAre());
  EXPECT_THAT(outside(0.51), ElementsAre(1));
  EXPECT_THAT(outside(1.0), ElementsAre(0, 1, 2, 3, 4));
}

TEST_F(BallsOfFiveParticles, ASphereWithoutARadiusContainsNothing) {
  balls_.set(3, into_ * Vector3(positions_.col(2)), 0.0);
  balls_.set(4, into_ * Vector3(positions_.col(3)), -1.0);
  EXPECT_THAT(outside(0.0), ElementsAre(3, 4));
  EXPECT_EQ(balls_.radius(3), 0.0);
  EXPECT_EQ(balls_.radius(2), 1.0);
}

TEST_F(BallsOfFiveParticles, AParticleThatIsNotFiniteIsOutside) {
  positions_.col(6)[1] = kNaN;
  EXPECT_THAT(outside(0.0), ElementsAre(0));
}

TEST(SphereSet, HoldNothingAtFirst) {
  std::vector<Index> found;
  SphereSet(2).find_outside({Points::Zero(3, 2), {0, 1}, RigidTransform::Identity()}, 0.0, found);
  EXPECT_THAT(found, ElementsAre(0, 1));
}

}  // namespace
}  // namespace sprung
