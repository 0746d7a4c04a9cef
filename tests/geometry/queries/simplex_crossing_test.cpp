#include "geometry/queries/simplex_crossing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace sprung {
namespace {

using Grid = Eigen::Matrix<std::int64_t, 3, 1>;
using Corners = std::vector<Grid>;

std::vector<Grid> edges_of(const Corners& x) {
  std::vector<Grid> edges;
  for (std::size_t i = 0; i + 1 < x.size() || (x.size() == 3 && i < 3); ++i) edges.push_back(x[(i + 1) % x.size()] - x[i]);
  return edges;
}

bool has_area(const Corners& x) { return x.size() == 3 && !(x[1] - x[0]).cross(x[2] - x[0]).isZero(); }

/// Whether the projections onto the axis leave a gap.
bool separates(const Grid& axis, const Corners& x, const Corners& y) {
  const auto range = [&](const Corners& corners) {
    std::pair<std::int64_t, std::int64_t> result{std::numeric_limits<std::int64_t>::max(),
                                                 std::numeric_limits<std::int64_t>::min()};
    for (const Grid& corner : corners) {
      result.first = std::min(result.first, axis.dot(corner));
      result.second = std::max(result.second, axis.dot(corner));
    }
    return result;
  };
  return range(x).second < range(y).first || range(y).second < range(x).first;
}

/// Convex hulls are disjoint if and only if one of these axes separates them: normals, cross products of edges and, within a plane
/// or on a line, edges rotated in the plane and edges themselves. Exact in integers.
bool expected_to_intersect(const Corners& x, const Corners& y) {
  std::vector<Grid> axes;
  std::vector<Grid> edges = edges_of(x);
  const std::vector<Grid> others = edges_of(y);
  edges.insert(edges.end(), others.begin(), others.end());
  const Grid between = y[0] - x[0];
  edges.push_back(between);
  for (const Grid& e : edges) {
    for (const Grid& f : edges) {
      axes.push_back(e.cross(f));
      for (const Grid& g : edges) axes.push_back(e.cross(f).cross(g));
    }
    axes.push_back(e);
  }
  return std::none_of(axes.begin(), axes.end(), [&](const Grid& axis) { return separates(axis, x, y); });
}

Vector3 scaled(const Grid& p, double scale) { return scale * p.cast<double>(); }

bool found_to_intersect(const Corners& x, const Corners& y, double scale) {
  Simplex simplex{.count = static_cast<int>(x.size())};
  for (std::size_t i = 0; i < x.size(); ++i) simplex.x[i] = scaled(x[i], scale);
  return intersects(simplex, {scaled(y[0], scale), scaled(y[1], scale), scaled(y[2], scale)});
}

class SimplexCrossing : public testing::Test {
 protected:
  std::mt19937_64 random_{5};

  Corners corners(int count, int range) {
    Corners result;
    for (int i = 0; i < count; ++i) {
      const auto coordinate = [&] { return static_cast<std::int64_t>(random_() % static_cast<unsigned>(range)); };
      result.emplace_back(coordinate(), coordinate(), coordinate());
    }
    return result;
  }
};

TEST_F(SimplexCrossing, AgreesWithIntegerArithmeticForTouchingAndCoplanarSimplices) {
  // Small grids contain all special cases: shared corners, edges in a plane, points on edges.
  for (const int range : {2, 3, 5, 100}) {
    for (int count = 1; count <= 3; ++count) {
      int intersecting = 0;
      for (int trial = 0; trial < 4000; ++trial) {
        const Corners x = corners(count, range);
        const Corners y = corners(3, range);
        if (!has_area(y) || (count == 3 && !has_area(x))) continue;
        const bool expected = expected_to_intersect(x, y);
        intersecting += expected ? 1 : 0;
        ASSERT_EQ(found_to_intersect(x, y, 1.0), expected) << "range " << range << " corners " << count << " trial " << trial;
        ASSERT_EQ(found_to_intersect(x, y, 0x1p-40), expected);
      }
      if (range <= 5) {
        EXPECT_GT(intersecting, 20) << "range " << range << " corners " << count;
      }
    }
  }
}

TEST_F(SimplexCrossing, SegmentsAgreeWithIntegerArithmeticInSpaceInAPlaneAndOnALine) {
  const std::array<std::vector<Grid>, 3> spans{
      std::vector<Grid>{Grid(1, 0, 0), Grid(0, 1, 0), Grid(0, 0, 1)}, {Grid(3, 1, 2), Grid(-1, 2, 1)}, {Grid(2, 0, -3)}};
  for (const std::vector<Grid>& span : spans) {
    int intersecting = 0;
    for (int trial = 0; trial < 4000; ++trial) {
      Corners x = corners(4, span.size() == 1 ? 8 : 3);
      for (Grid& corner : x) {
        Grid point = Grid::Zero();
        for (std::size_t k = 0; k < span.size(); ++k) point += corner[static_cast<Eigen::Index>(k)] * span[k];
        corner = point;
      }
      const bool expected = expected_to_intersect({x[0], x[1]}, {x[2], x[3]});
      intersecting += expected ? 1 : 0;
      for (const double scale : {1.0, 0x1p-40}) {
        ASSERT_EQ(intersects(scaled(x[0], scale), scaled(x[1], scale), scaled(x[2], scale), scaled(x[3], scale)), expected)
            << span.size() << " dimensions, trial " << trial;
      }
    }
    EXPECT_GT(intersecting, 100) << span.size() << " dimensions";
    EXPECT_LT(intersecting, 3900) << span.size() << " dimensions";
  }
}

TEST_F(SimplexCrossing, AgreesWithIntegerArithmeticWithinOnePlane) {
  const Grid along(3, 1, 2);
  const Grid across(-1, 2, 1);
  int intersecting = 0;
  for (int count = 1; count <= 3; ++count) {
    for (int trial = 0; trial < 4000; ++trial) {
      const auto in_plane = [&](Corners corners) {
        for (Grid& corner : corners) corner = Grid(corner[0] * along + corner[1] * across);
        return corners;
      };
      const Corners x = in_plane(corners(count, 5));
      const Corners y = in_plane(corners(3, 5));
      if (!has_area(y) || (count == 3 && !has_area(x))) continue;
      const bool expected = expected_to_intersect(x, y);
      intersecting += expected ? 1 : 0;
      ASSERT_EQ(found_to_intersect(x, y, 1.0), expected) << "corners " << count << " trial " << trial;
    }
  }
  EXPECT_GT(intersecting, 1000);
}

TEST_F(SimplexCrossing, RoundingNeitherCreatesNorHidesACrossing) {
  // The end of a segment one rounding above, on and below a face far from the origin.
  const std::array<Vector3, 3> face{Vector3(1000, 1000, 1000), Vector3(1001, 1000, 1000), Vector3(1000, 1000, 1001)};
  const double above = std::nextafter(1000.0, 2000.0);
  const double below = std::nextafter(1000.0, 0.0);
  const Vector3 far(1000.3, 1001.0, 1000.3);
  EXPECT_FALSE(intersects(far, Vector3(1000.25, above, 1000.25), face));
  EXPECT_TRUE(intersects(far, Vector3(1000.25, 1000.0, 1000.25), face));
  EXPECT_TRUE(intersects(far, Vector3(1000.25, below, 1000.25), face));
}

}  // namespace
}  // namespace sprung
