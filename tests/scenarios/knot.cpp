#include "scenarios/knot.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace sprung::testing {
namespace {

/// Where one segment's shadow crosses another's.
struct Passage {
  double place = 0.0;  ///< along the polyline, in segments
  int crossing = 0;
  bool below = false;
};

double cross(const Vector3& a, const Vector3& b) { return a.x() * b.y() - a.y() * b.x(); }

struct Meeting {
  double at_first = 0.0;  ///< part of the segment
  double at_second = 0.0;
};

std::optional<Meeting> shadows_meet(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const double area = cross(b - a, d - c);
  const Meeting meeting = {cross(c - a, d - c) / area, cross(c - a, b - a) / area};
  const auto within = [](double part) { return part > 0.0 && part < 1.0; };
  if (!within(meeting.at_first) || !within(meeting.at_second)) return std::nullopt;
  return meeting;
}

/// All passages in the order in which the polyline comes to them. The shadow falls along z.
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
      const auto meeting = shadows_meet(a, b, c, d);
      if (!meeting) continue;
      const double height_first = a.z() + meeting->at_first * (b.z() - a.z());
      const double height_second = c.z() + meeting->at_second * (d.z() - c.z());
      result.push_back({i + meeting->at_first, crossings, height_first < height_second});
      result.push_back({k + meeting->at_second, crossings, height_first > height_second});
      ++crossings;
    }
  }
  std::sort(result.begin(), result.end(), [](const Passage& a, const Passage& b) { return a.place < b.place; });
  return result;
}

}  // namespace

int knot_determinant(const Points& closed_polyline) {
  // Turned so that nothing in a scene, which likes its axes, casts its shadow onto itself.
  const Matrix3 askew = Eigen::AngleAxisd(1.234, Vector3(1.0, 0.7, 0.3).normalized()).toRotationMatrix();
  const std::vector<Passage> all = passages(askew * closed_polyline);
  const auto crossings = static_cast<Index>(all.size() / 2);
  if (crossings < 2) return 1;
  // Strands go from one passage below to the next; as many as crossings.
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
