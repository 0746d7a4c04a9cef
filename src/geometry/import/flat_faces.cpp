#include "geometry/import/flat_faces.h"

#include "geometry/mesh/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace sprung {
namespace {

// A triangle whose height over longest side is below this is a line.
constexpr double kFlat = 1e-12;

using Corners = std::array<Index, 3>;
using Edge = std::pair<Index, Index>;

Edge edge_of(Index a, Index b) { return std::minmax(a, b); }

bool is_line(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return area_normal(a, b, c).norm() <= kFlat * longest2;
}

bool is_line_in_all(const std::vector<Points>& frames, const Corners& corners) {
  return std::all_of(frames.begin(), frames.end(), [&](const Points& frame) {
    return is_line(frame.col(corners[0]), frame.col(corners[1]), frame.col(corners[2]));
  });
}

/// The faces of a mesh, of which some are split and removed.
class SplitFaces {
 public:
  explicit SplitFaces(const MeshSequence& mesh) : frames_(mesh.frames) {
    for (const auto& corners : mesh.triangles.colwise()) add({corners[0], corners[1], corners[2]});
  }

  /// Longest first, so that a flat neighbour is split into shorter ones. The number of splits is bounded, so that rounding cannot
  /// make this endless.
  void remove_flat() {
    std::size_t splits = 3 * flat_.size();
    while (!flat_.empty()) {
      const Index face = std::prev(flat_.end())->second;
      flat_.erase(std::prev(flat_.end()));
      remove(face);
      if (splits > 0 && split_neighbour(faces_[face])) --splits;
    }
  }

  [[nodiscard]] Triangles triangles() const {
    Triangles result(3, std::count(kept_.begin(), kept_.end(), true));
    Index column = 0;
    for (std::size_t face = 0; face < faces_.size(); ++face) {
      if (kept_[face]) result.col(column++) << faces_[face][0], faces_[face][1], faces_[face][2];
    }
    return result;
  }

 private:
  [[nodiscard]] double length2(Index a, Index b) const { return (frames_[0].col(a) - frames_[0].col(b)).squaredNorm(); }

  /// The corners, turned so that the longest side comes last.
  [[nodiscard]] Corners with_longest_last(Corners corners) const {
    const auto side = [&](int k) { return length2(corners[k], corners[(k + 1) % 3]); };
    while (side(2) < side(0) || side(2) < side(1)) std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    return corners;
  }

  void add(const Corners& corners) {
    const auto face = static_cast<Index>(faces_.size());
    faces_.push_back(corners);
    kept_.push_back(true);
    for (int k = 0; k < 3; ++k) faces_at_[edge_of(corners[k], corners[(k + 1) % 3])].push_back(face);
    if (!is_line_in_all(frames_, corners)) return;
    const Corners turned = with_longest_last(corners);
    flat_.insert({length2(turned[2], turned[0]), face});
  }

  void remove(Index face) {
    kept_[face] = false;
    for (int k = 0; k < 3; ++k) std::erase(faces_at_[edge_of(faces_[face][k], faces_[face][(k + 1) % 3])], face);
  }

  /// Splits the face on the other side of the longest side of a flat face, at the corner that lies on that side. False if there is
  /// none.
  bool split_neighbour(const Corners& flat) {
    const auto [from, middle, to] = with_longest_last(flat);
    if (from == middle || middle == to || from == to) return false;
    const std::vector<Index>& others = faces_at_[edge_of(from, to)];
    if (others.size() != 1) return false;  // two faces that share the side are joined already
    const Index face = others.front();
    const Corners corners = faces_[face];
    if (std::ranges::find(corners, middle) != corners.end()) return false;
    std::erase_if(flat_, [&](const auto& entry) { return entry.second == face; });
    remove(face);
    for (int k = 0; k < 3; ++k) {
      const Index a = corners[k];
      const Index b = corners[(k + 1) % 3];
      const Index opposite = corners[(k + 2) % 3];
      if (edge_of(a, b) != edge_of(from, to)) continue;
      add({a, middle, opposite});
      add({middle, b, opposite});
    }
    return true;
  }

  const std::vector<Points>& frames_;
  std::vector<Corners> faces_;
  std::vector<bool> kept_;
  std::map<Edge, std::vector<Index>> faces_at_;
  std::set<std::pair<double, Index>> flat_;  ///< by squared length of the longest side in the first frame
};

}  // namespace

Index remove_flat_faces(MeshSequence& mesh) {
  const auto is_flat = [&](const auto& corners) { return is_line_in_all(mesh.frames, {corners[0], corners[1], corners[2]}); };
  const auto faces_read = mesh.triangles.colwise();
  const auto count = static_cast<Index>(std::count_if(faces_read.begin(), faces_read.end(), is_flat));
  if (count == 0) return 0;
  SplitFaces faces(mesh);
  faces.remove_flat();
  mesh.triangles = faces.triangles();
  return count;
}

}  // namespace sprung
