#include "collision/core/sphere_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace sprung {
namespace {

using ::testing::ElementsAre;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Seven particles on a line, five of which have a sphere, and a frame that is rotated and translated.
class SphereSetOfFiveParticles : public ::testing::Test {
 protected:
  SphereSetOfFiveParticles() : into_(Eigen::Translation3d(1.0, 2.0, 3.0) * Eigen::AngleAxisd(0.5, Vector3(1.0, 2.0, 2.0) / 3.0)) {
    for (Index i = 0; i < positions_.cols(); ++i) positions_.col(i) = Vector3(i, 0.0, 0.0);
    for (Index sphere = 0; sphere < 5; ++sphere) spheres_.set(sphere, into_ * Vector3(positions_.col(particles_[at(sphere)])), 1.0);
  }

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  std::vector<Index> outside(double margin) const {
    std::vector<Index> found{7};
    spheres_.find_outside({positions_, particles_, into_}, margin, found);
    return found;
  }

  Points positions_{3, 7};
  std::vector<Index> particles_{6, 1, 5, 2, 3};
  RigidTransform into_;
  SphereSet spheres_{5};
};

TEST_F(SphereSetOfFiveParticles, ParticlesThatStayAreInside) { EXPECT_THAT(outside(0.0), ElementsAre()); }

TEST_F(SphereSetOfFiveParticles, ParticlesThatMoveByMoreThanTheRadiusAreOutside) {
  positions_.col(5) += Vector3(0.0, 1.01, 0.0);
  positions_.col(3) += Vector3(0.0, 0.0, -1.01);
  positions_.col(1) += Vector3(0.0, 0.99, 0.0);
  positions_.col(0) += Vector3(9.0, 9.0, 9.0);
  EXPECT_THAT(outside(0.0), ElementsAre(2, 4));
}

TEST_F(SphereSetOfFiveParticles, AMarginReducesTheRadius) {
  positions_.col(1) += Vector3(0.0, 0.5, 0.0);
  EXPECT_THAT(outside(0.49), ElementsAre());
  EXPECT_THAT(outside(0.51), ElementsAre(1));
  EXPECT_THAT(outside(1.0), ElementsAre(0, 1, 2, 3, 4));
}

TEST_F(SphereSetOfFiveParticles, ASphereWithoutARadiusContainsNothing) {
  spheres_.set(3, into_ * Vector3(positions_.col(2)), 0.0);
  spheres_.set(4, into_ * Vector3(positions_.col(3)), -1.0);
  EXPECT_THAT(outside(0.0), ElementsAre(3, 4));
  EXPECT_EQ(spheres_.radius(3), 0.0);
  EXPECT_EQ(spheres_.radius(2), 1.0);
}

TEST_F(SphereSetOfFiveParticles, AParticleThatIsNotFiniteIsOutside) {
  positions_.col(6)[1] = kNaN;
  EXPECT_THAT(outside(0.0), ElementsAre(0));
}

TEST(SphereSet, AllSpheresAreEmptyAtFirst) {
  std::vector<Index> found;
  SphereSet(2).find_outside({Points::Zero(3, 2), {0, 1}, RigidTransform::Identity()}, 0.0, found);
  EXPECT_THAT(found, ElementsAre(0, 1));
}

}  // namespace
}  // namespace sprung
