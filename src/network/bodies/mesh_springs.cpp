#include "network/bodies/mesh_springs.h"

#include <algorithm>
#include <span>
#include <tuple>

namespace sprung {
namespace {

// A side of a face: its two ends, and the corners of the face next to them.
struct Side {
  Index first = 0;
  Index second = 0;
  Index beyond_first = 0;
  Index beyond_second = 0;
  double face_area = 0.0;
};

class JointCollector {
 public:
  explicit JointCollector(const PolygonMesh& mesh) : mesh_(mesh) {}

  void add_face(std::span<const Index> corners) {
    const std::size_t n = corners.size();
    const auto corner = [&](std::size_t i) { return corners[i % n]; };
    const double area = fan_area(corners);
    const std::size_t diagonals = n == 4 ? 2 : (n > 4 ? n : 0);
    for (std::size_t i = 0; i < n; ++i) {
      add(corner(i), corner(i + 1), SpringKind::structural, 2.0 * area / static_cast<double>(n));
      add_side(corner(i), corner(i + 1), corner(i + n - 1), corner(i + 2), area);
    }
    for (std::size_t i = 0; i < diagonals; ++i) {
      add(corner(i), corner(i + 2), SpringKind::shear, 2.0 * area / static_cast<double>(diagonals));
    }
  }

  void add_line(Index a, Index b) { add(a, b, SpringKind::structural, 0.0); }

  void add_bends() {
    std::stable_sort(sides_.begin(), sides_.end(),
                     [](const Side& a, const Side& b) { return std::tie(a.first, a.second) < std::tie(b.first, b.second); });
    for (std::size_t s = 1; s < sides_.size(); ++s) {
      const Side& a = sides_[s - 1];
      const Side& b = sides_[s];
      if (a.first != b.first || a.second != b.second) continue;
      const double area = (a.face_area + b.face_area) / 2.0;
      add(a.beyond_first, b.beyond_first, SpringKind::bend, area);
      add(a.beyond_second, b.beyond_second, SpringKind::bend, area);
    }
  }

  // One joint per pair: the first kind wins, and the areas of that kind are added.
  std::vector<Joint> merged() {
    std::stable_sort(joints_.begin(), joints_.end(), [](const Joint& a, const Joint& b) {
      return std::tie(a.first, a.second, a.kind) < std::tie(b.first, b.second, b.kind);
    });
    std::vector<Joint> result;
    for (const Joint& joint : joints_) {
      const bool same_pair = !result.empty() && result.back().first == joint.first && result.back().second == joint.second;
      if (!same_pair) {
        result.push_back(joint);
      } else if (result.back().kind == joint.kind) {
        result.back().area += joint.area;
      }
    }
    return result;
  }

 private:
  void add(Index a, Index b, SpringKind kind, double area) {
    if (a != b) joints_.push_back({std::min(a, b), std::max(a, b), kind, area});
  }

  void add_side(Index a, Index b, Index beyond_a, Index beyond_b, double area) {
    if (a < b) {
      sides_.push_back({a, b, beyond_a, beyond_b, area});
    } else {
      sides_.push_back({b, a, beyond_b, beyond_a, area});
    }
  }

  double fan_area(std::span<const Index> corners) const {
    const Vector3 origin = mesh_.vertices.col(corners[0]);
    double area = 0.0;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      const Vector3 a = mesh_.vertices.col(corners[i]) - origin;
      const Vector3 b = mesh_.vertices.col(corners[i + 1]) - origin;
      area += a.cross(b).norm() / 2.0;
    }
    return area;
  }

  const PolygonMesh& mesh_;
  std::vector<Joint> joints_;
  std::vector<Side> sides_;
};

}  // namespace

std::vector<Joint> mesh_joints(const PolygonMesh& mesh) {
  JointCollector collector(mesh);
  const std::span<const Index> vertices(mesh.faces.vertex);
  for (Index f = 0; f < mesh.faces.face_count(); ++f) {
    const auto begin = static_cast<std::size_t>(mesh.faces.corner_begin[f]);
    const auto end = static_cast<std::size_t>(mesh.faces.corner_begin[f + 1]);
    collector.add_face(vertices.subspan(begin, end - begin));
  }
  for (const auto& line : mesh.lines.colwise()) collector.add_line(line[0], line[1]);
  collector.add_bends();
  return collector.merged();
}

}  // namespace sprung
