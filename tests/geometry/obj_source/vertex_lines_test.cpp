#include "geometry/obj_source/vertex_lines.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sprung {
namespace {

TEST(VertexLines, AreTheSameForEveryNumberOfVerticesAndChunks) {
  Points points(3, 10'000);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = std::sin(static_cast<double>(i)) / 3.0;
  std::string expected;
  for (Eigen::Index i = 0; i < points.cols(); ++i) expected += vertex_lines(points.col(i));
  EXPECT_EQ(vertex_lines(points), expected);
  EXPECT_EQ(vertex_lines(Points(3, 0)), "");
}

}  // namespace
}  // namespace sprung
