#include "scenarios/knot.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace sprung::testing {
namespace {

/// One of the two times that the polyline passes a crossing of its projection.
struct Passage {
  double position = 0.0;  ///< along the polyline, in segments
  int crossing = 0;
  bool below = false;
};

double cross(const Vector3& a, const Vector3& b) { return a.x() * b.y() - a.y() * b.x(); }

struct CrossingPoint {
  double at_first = 0.0;  ///< fraction of the segment
  double at_second = 0.0;
};

std::optional<CrossingPoint> projections_cross(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const double area = cross(b - a, d - c);
  const CrossingPoint crossing = {cross(c - a, d - c) / area, cross(c - a, b - a) / area};
  const auto within = [](double fraction) { return fraction > 0.0 && fraction < 1.0; };
  if (!within(crossing.at_first) || !within(crossing.at_second)) return std::nullopt;
  return crossing;
}

/// All passages in their order along the polyline, which is projected along z.
std::vector<Passage> passages(const Points& x) {
  const Index n = static_cast<Index>(x.cols());
  std::vector<Passage> result;
  int crossings = 0;
  for (Index i = 0; i < n; ++i) {
    for (Index k = i + 2; k < n; ++k) {
      const Vector3 a = x.col(i);
      const Vector3 b = x.col((i + 1) % n);
      const Vector3 c = x.col(k);
      const Vector3 d = x.col((k + 1) % n);
      if (i == (k + 1) % n) continue;
      const auto crossing = projections_cross(a, b, c, d);
      if (!crossing) continue;
      const double height_first = a.z() + crossing->at_first * (b.z() - a.z());
      const double height_second = c.z() + crossing->at_second * (d.z() - c.z());
      result.push_back({i + crossing->at_first, crossings, height_first < height_second});
      result.push_back({k + crossing->at_second, crossings, height_first > height_second});
      ++crossings;
    }
  }
  std::sort(result.begin(), result.end(), [](const Passage& a, const Passage& b) { return a.position < b.position; });
  return result;
}

}  // namespace

int knot_determinant(const Points& closed_polyline) {
  // Ropes of scenes often lie along axes. The rotation keeps their segments from being projected onto each other.
  const Matrix3 askew = Eigen::AngleAxisd(1.234, Vector3(1.0, 0.7, 0.3).normalized()).toRotationMatrix();
  const std::vector<Passage> all = passages(askew * closed_polyline);
  const auto crossings = static_cast<Index>(all.size() / 2);
  if (crossings < 2) return 1;
  // A strand reaches from one passage below to the next. There are as many strands as crossings.
  Eigen::MatrixXd colours = Eigen::MatrixXd::Zero(crossings, crossings);
  Index strand = 0;
  for (const Passage& passage : all) {
    if (!passage.below) {
      colours(passage.crossing, strand) += 2.0;
      continue;
    }
    colours(passage.crossing, strand) -= 1.0;
    strand = (strand + 1) % crossings;
    colours(passage.crossing, strand) -= 1.0;
  }
  return static_cast<int>(std::lround(std::abs(colours.topLeftCorner(crossings - 1, crossings - 1).determinant())));
}

Points closed_far_away(const Points& rope) {
  const Index n = static_cast<Index>(rope.cols());
  const Vector3 first = rope.col(0);
  const Vector3 last = rope.col(n - 1);
  const double far = 10.0 * (rope.rowwise().maxCoeff() - rope.rowwise().minCoeff()).norm();
  const Vector3 along = (last - first).normalized();
  const Vector3 aside = far * along.unitOrthogonal();
  Points closed(3, n + 4);
  closed.leftCols(n) = rope;
  closed.col(n) = last + far * along;
  closed.col(n + 1) = last + far * along + aside;
  closed.col(n + 2) = first - far * along + aside;
  closed.col(n + 3) = first - far * along;
  return closed;
}

}  // namespace sprung::testing
