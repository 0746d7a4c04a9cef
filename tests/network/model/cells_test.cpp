#include "network/model/cells.h"

#include "base/error.h"
#include "network/network_builder.h"
#include "network/total_volume.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace sprung {
namespace {

constexpr Hexahedron kCube{0, 1, 2, 3, 4, 5, 6, 7};

Points cube_corners() {
  Points corners(3, 8);
  for (Index c = 0; c < 8; ++c) corners.col(c) << c % 2, c / 2 % 2, c / 4;
  return corners;
}

// The determinant of the trilinear map's derivative is a polynomial of degree 2 in each coordinate, which two Gauss points
// integrate exactly.
double integrated_volume(const Points& corners) {
  const std::array<double, 2> points{0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)};
  double volume = 0.0;
  for (const double x : points) {
    for (const double y : points) {
      for (const double z : points) {
        Matrix3 derivative = Matrix3::Zero();
        for (Index c = 0; c < 8; ++c) {
          const Vector3 at(x, y, z);
          Vector3 weight;
          Vector3 slope;
          for (int axis = 0; axis < 3; ++axis) {
            const bool upper = (c >> axis & 1) == 1;
            weight[axis] = upper ? at[axis] : 1.0 - at[axis];
            slope[axis] = upper ? 1.0 : -1.0;
          }
          const Vector3 gradient(slope[0] * weight[1] * weight[2], weight[0] * slope[1] * weight[2],
                                 weight[0] * weight[1] * slope[2]);
          derivative += corners.col(c) * gradient.transpose();
        }
        volume += derivative.determinant() / 8.0;
      }
    }
  }
  return volume;
}

TEST(Cells, VolumeOfAHexahedronIsThatOfItsTrilinearMap) {
  std::mt19937 random(1);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same cells in every run are intended
  std::uniform_real_distribution<double> offset(-0.3, 0.3);
  for (int trial = 0; trial < 20; ++trial) {
    Points corners = cube_corners();
    for (Index c = 0; c < 8; ++c) corners.col(c) += Vector3(offset(random), offset(random), offset(random));
    EXPECT_NEAR(volume_of(kCube, corners), integrated_volume(corners), 1.0e-14);
  }
}

TEST(Cells, ACornerPushedThroughItsOppositeFaceIsInverted) {
  Points corners = cube_corners();
  EXPECT_FALSE(is_inverted(kCube, corners));
  // The plane of the three neighbours of corner 0 is x + y + z = 1.
  corners.col(0) = Vector3::Constant(0.33);
  EXPECT_FALSE(is_inverted(kCube, corners));
  corners.col(0) = Vector3::Constant(0.34);
  EXPECT_TRUE(is_inverted(kCube, corners));
}

TEST(Cells, ThoseOfASolidFillIt) {
  NetworkBuilder builder;
  builder.add_particle(Vector3::Zero(), 1.0);  // so that numbers within the body differ from those of the network
  BodyShape solid = make_solid({.size = {1.0, 2.0, 3.0}, .resolution = {3, 4, 2}}, {});
  set_total_mass(solid, 1.0);
  builder.add_body("solid", solid);
  const SpringNetwork network = builder.build();
  const Body& body = network.bodies[1];
  EXPECT_EQ(body.cells.hexahedra.size(), 2U * 3U * 1U);
  EXPECT_NEAR(testing::total_volume(body.cells, network.positions.middleCols(body.first_particle, body.particle_count)), 6.0,
              1.0e-14);
}

TEST(Cells, ABodyRefusesThoseThatAreInsideOut) {
  NetworkBuilder builder;
  BodyShape solid = make_solid({}, {});
  set_total_mass(solid, 1.0);
  std::swap(solid.cells.hexahedra[0][0], solid.cells.hexahedra[0][1]);
  builder.add_body("solid", solid);
  EXPECT_THROW((void)builder.build(), InputError);
}

}  // namespace
}  // namespace sprung
