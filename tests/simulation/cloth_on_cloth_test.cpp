// Sliding contact between two bodies of the network: different edges and faces pass each other in each step.
#include "network/network_builder.h"
#include "simulation/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <ostream>
#include <vector>

namespace sprung {
namespace {

using testing::kGravity;

constexpr double kThickness = 0.01;  // [m] between the cloths
constexpr double kDuration = 1.0;    // [s]

struct Slide {
  double angle;     ///< of the slope [degrees]
  double friction;  ///< static and kinetic
  double rate;      ///< steps a second
  Index resolution;
};

void PrintTo(const Slide& slide, std::ostream* stream) {
  *stream << slide.angle << " degrees, friction " << slide.friction << ", " << slide.rate << " steps, " << slide.resolution
          << " squared";
}

BodyShape level_cloth(const std::array<double, 2>& size, const std::array<Index, 2>& resolution, const Vector3& middle) {
  const SpringMaterial without_force{};
  BodyShape shape = make_cloth({.size = size, .resolution = resolution}, {without_force, without_force, without_force});
  set_total_mass(shape, 0.05);
  RigidTransform pose = RigidTransform::Identity();
  pose.translate(middle);
  pose.rotate(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Vector3::UnitX()));
  place(shape, pose);
  return shape;
}

/// A cloth that lies near one end of a longer cloth, which is pinned entirely.
SpringNetwork cloth_on_cloth(const Slide& slide) {
  const ContactMaterial material{.thickness = kThickness, .friction = slide.friction, .static_friction = slide.friction};
  NetworkBuilder builder;
  const BodyShape below = level_cloth({4.0, 1.0}, {80, 20}, Vector3::Zero());
  std::vector<Index> all(static_cast<std::size_t>(below.positions.size()));
  std::iota(all.begin(), all.end(), builder.add_body("below", below, material));
  builder.pin(all);
  builder.add_body("above", level_cloth({0.3, 0.3}, {slide.resolution, slide.resolution}, {-1.5, kThickness, 0.0}), material);
  return builder.build();
}

class ClothOnCloth : public ::testing::TestWithParam<Slide> {};
INSTANTIATE_TEST_SUITE_P(Slides, ClothOnCloth,
                         ::testing::Values(Slide{30.0, 0.0, 240.0, 6}, Slide{30.0, 0.0, 240.0, 15}, Slide{30.0, 0.0, 960.0, 6},
                                           Slide{35.0, 0.5, 240.0, 6}, Slide{35.0, 0.5, 240.0, 15}, Slide{35.0, 0.5, 960.0, 6},
                                           Slide{26.0, 0.5, 240.0, 6}));

// Coulomb's law with inclined gravity instead of an inclined slope. The speed may lag by the velocity of one step. A cloth at rest
// may settle by a thousandth of the gap.
//
// Within a step the weight moves the cloth by g dt^2 into the gap d. There its particles touch the round border at the sine s =
// sqrt(2 g dt^2 / d). At a speed v the border lifts them by (v s)^2 / 2 g = (v dt)^2 / d.
TEST_P(ClothOnCloth, SlidesAsFarAsAPointAndStaysDown) {
  const auto& [angle, friction, rate, resolution] = GetParam();
  const double slope = angle * std::numbers::pi / 180.0;
  const double pull = kGravity * std::max(0.0, std::sin(slope) - friction * std::cos(slope));
  using enum SpringKind;
  Simulator simulator(cloth_on_cloth(GetParam()),
                      {.step = 1.0 / rate,
                       .gravity = kGravity * Vector3(std::sin(slope), -std::cos(slope), 0.0),
                       .stretch_limit = StretchLimitSettings{.max_stretch = 0.02, .kinds = {structural, shear}, .iterations = 20}});
  const Index count = resolution * resolution;
  const auto above = [&] { return simulator.positions().rightCols(count); };
  const double begin = above().row(0).mean();
  double highest = 0.0;
  for (int step = 0; step < static_cast<int>(kDuration * rate); ++step) {
    simulator.step();
    highest = std::max(highest, above().row(1).maxCoeff());
  }
  EXPECT_NEAR(above().row(0).mean() - begin, 0.5 * pull * kDuration * kDuration, pull * kDuration / rate + 1e-3 * kThickness);
  const double displacement = pull * kDuration / rate;
  EXPECT_LT(highest, 1.1 * kThickness + displacement * displacement / kThickness);
}

// All rows fold alike, so no row blocks another. With the nearest points at the ends of steps, as between bodies, the rows
// crumpled and truncation stopped them hundreds of times a second.
TEST(ClothOnItself, FoldsEvenlyWhenItFallsOnItsEdge) {
  const SpringMaterial without_force{};
  BodyShape shape = make_cloth({.size = {0.6, 0.6}, .resolution = {20, 20}}, {without_force, without_force, without_force});
  set_total_mass(shape, 0.1);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees({3.0, 20.0, 0.0});
  pose.translation().y() = 0.32;
  place(shape, pose);
  NetworkBuilder builder;
  builder.add_body("cloth", shape, {.thickness = 0.008, .friction = 0.5, .static_friction = 0.5}, {.self = true});
  Simulator simulator(builder.build(),
                      {.step = 1.0 / 120.0, .stretch_limit = StretchLimitSettings{.max_stretch = 0.02, .iterations = 20}},
                      {testing::ground({.friction = 0.5, .static_friction = 0.5})});
  Index truncated = 0;
  for (int step = 0; step < 120; ++step) truncated += simulator.step().truncated;
  EXPECT_EQ(truncated, 0);
}

}  // namespace
}  // namespace sprung
