#include "collision/surface/self_intersections.h"

#include "collision/core/block_bounds.h"
#include "geometry/queries/simplex_crossing.h"

#include <algorithm>
#include <utility>

namespace sprung {

namespace {

Box3 box_of(const Element& element, const Points& positions) {
  Box3 box;
  for (std::size_t i = 0; i < static_cast<std::size_t>(element.corners); ++i) box.extend(positions.col(element.particles[i]));
  return box;
}

bool has(const Element& element, Index particle) {
  return std::find(element.particles.begin(), element.particles.end(), particle) != element.particles.end();
}

bool is_triangle(const Element& element) { return element.corners == 3; }

bool edge_intersects(const Element& from, const Element& other, const Points& positions) {
  const auto corners = static_cast<std::size_t>(other.corners);
  const std::array<Vector3, 3> x{positions.col(other.particles[0]), positions.col(other.particles[1 % corners]),
                                 positions.col(other.particles[2 % corners])};
  const Vector3 low = x[0].cwiseMin(x[1]).cwiseMin(x[2]);
  const Vector3 high = x[0].cwiseMax(x[1]).cwiseMax(x[2]);
  const int edges = from.corners == 3 ? 3 : 1;
  for (int k = 0; k < edges; ++k) {
    const Index a = from.particles[static_cast<std::size_t>(k)];
    const Index b = from.particles[static_cast<std::size_t>((k + 1) % from.corners)];
    if (has(other, a) || has(other, b)) continue;
    const Vector3 begin = positions.col(a);
    const Vector3 end = positions.col(b);
    if ((begin.cwiseMin(end).array() > high.array()).any() || (begin.cwiseMax(end).array() < low.array()).any()) continue;
    if (is_triangle(other) ? intersects(begin, end, x) : intersects(begin, end, x[0], x[1])) return true;
  }
  return false;
}

class SelfSearch {
 public:
  SelfSearch(const CollisionSurface& surface, const Points& positions) : surface_(surface), positions_(positions) {
    boxes_.reserve(surface.elements.size());
    for (const Element& element : surface.elements) boxes_.push_back(box_of(element, positions));
    for (const ElementPatch& patch : surface.patches) {
      Box3 box;
      for (Index e = patch.first_element; e < patch.first_element + patch.element_count; ++e) box.extend(element_box(e));
      patch_boxes_.push_back(box);
      by_begin_.push_back(static_cast<Index>(by_begin_.size()));
    }
    std::sort(by_begin_.begin(), by_begin_.end(),
              [&](Index p, Index q) { return std::pair(patch_box(p).min().x(), p) < std::pair(patch_box(q).min().x(), q); });
  }

  /// Tests the patch with this number in `by_begin_` against itself and against the patches that begin within its extent along x.
  void search(std::size_t rank, std::vector<CrossingElements>& found) const {
    const Index patch = by_begin_[rank];
    search(patch, patch, found);
    for (std::size_t other = rank + 1; other < by_begin_.size(); ++other) {
      const Index next = by_begin_[other];
      if (patch_box(next).min().x() > patch_box(patch).max().x()) return;
      search(patch, next, found);
    }
  }

 private:
  [[nodiscard]] const Box3& element_box(Index e) const { return boxes_[static_cast<std::size_t>(e)]; }
  [[nodiscard]] const Box3& patch_box(Index p) const { return patch_boxes_[static_cast<std::size_t>(p)]; }
  [[nodiscard]] const ElementPatch& patch(Index p) const { return surface_.patches[static_cast<std::size_t>(p)]; }
  [[nodiscard]] const Element& element(Index e) const { return surface_.elements[static_cast<std::size_t>(e)]; }

  [[nodiscard]] bool may_collide(Index body, Index other) const {
    const auto a = static_cast<std::size_t>(body);
    const auto b = static_cast<std::size_t>(other);
    return a == b ? surface_.self[a] != 0 : surface_.others[a] != 0 && surface_.others[b] != 0;
  }

  /// Whether pins hold an end of both segments at one point. Ropes may do so.
  [[nodiscard]] bool hang_from_one_hook(const Element& a, const Element& b) const {
    if (is_triangle(a) || is_triangle(b)) return false;
    return std::ranges::any_of(corners_of(a), [&](Index i) {
      return is_fixed(surface_.motions, i) && std::ranges::any_of(corners_of(b), [&](Index j) {
               return is_fixed(surface_.motions, j) && positions_.col(i) == positions_.col(j);
             });
    });
  }

  void search(Index p, Index q, std::vector<CrossingElements>& found) const {
    if (!may_collide(element(patch(p).first_element).body, element(patch(q).first_element).body)) return;
    if (!patch_box(p).intersects(patch_box(q))) return;
    for (Index i = 0; i < patch(p).element_count; ++i) {
      const Index a = patch(p).first_element + i;
      for (Index j = p == q ? i + 1 : 0; j < patch(q).element_count; ++j) {
        const Index b = patch(q).first_element + j;
        if (!element_box(a).intersects(element_box(b)) || hang_from_one_hook(element(a), element(b))) continue;
        if (!edge_intersects(element(a), element(b), positions_) && !edge_intersects(element(b), element(a), positions_)) continue;
        found.push_back({std::min(a, b), std::max(a, b)});
      }
    }
  }

  const CollisionSurface& surface_;
  const Points& positions_;
  std::vector<Box3> boxes_;        ///< by element
  std::vector<Box3> patch_boxes_;  ///< by patch
  std::vector<Index> by_begin_;    ///< patches, sorted by their begin along x
};

}  // namespace

std::vector<CrossingElements> find_self_intersections(const CollisionSurface& surface, const Points& positions) {
  const auto any = [](const std::vector<char>& flags) { return std::find(flags.begin(), flags.end(), 1) != flags.end(); };
  if (!any(surface.self) && !any(surface.others)) return {};
  const SelfSearch search(surface, positions);
  auto all = collect_from_chunks<CrossingElements>(
      static_cast<Index>(surface.patches.size()), 1,
      [&](Index rank, Index, std::vector<CrossingElements>& found) { search.search(static_cast<std::size_t>(rank), found); });
  std::sort(all.begin(), all.end(),
            [](const auto& a, const auto& b) { return std::pair(a.first, a.second) < std::pair(b.first, b.second); });
  return all;
}

}  // namespace sprung
