#include "collision/obstacles/obstacle_intersections.h"

#include "base/parallel.h"
#include "collision/obstacles/obstacle_frame.h"

#include <algorithm>
#include <limits>

namespace sprung {

namespace {

// Fraction of the clearance. The clearance is 2^-30 of the coordinates, so this is 2^-40 of them, above the tolerance of safe
// regions.
constexpr double kTouching = 0x1p-10;

class PatchSearch {
 public:
  PatchSearch(const ObstacleFrame& frame, const CollisionSurface& surface, const Points& positions)
      : frame_(frame), surface_(surface), positions_(positions) {}

  /// A particle is tested only in the first patch that contains it.
  void search(Index patch_number, Intersections& found) const {
    const ElementPatch& patch = surface_.patches[static_cast<std::size_t>(patch_number)];
    Box3 box;
    for (const Index i : patch.particles) box.extend(positions_.col(i));
    const double margin = kTouching * frame_.max_clearance(box);
    std::vector<Index> near;
    frame_.find_near({box.min().array() - margin, box.max().array() + margin}, near);
    for (const Index k : near) {
      for (const Index i : patch.particles) {
        const Index first_slot = surface_.first_slot[static_cast<std::size_t>(i)];
        if (surface_.slots[static_cast<std::size_t>(first_slot)].patch == patch_number) find_inside(i, k, found);
      }
      for (Index e = patch.first_element; e < patch.first_element + patch.element_count; ++e) find_crossing(e, k, found);
    }
  }

 private:
  [[nodiscard]] double tolerance(const Vector3& position, Index k) const {
    return kTouching * frame_.clearance(k, position, position);
  }

  void find_inside(Index particle, Index k, Intersections& found) const {
    if (is_fixed(surface_.motions, particle)) return;
    const Vector3 p = frame_.local(k, positions_.col(particle));
    if (!frame_.shape(k).contains(p)) return;
    const auto surface = frame_.shape(k).nearest(p, std::numeric_limits<double>::infinity());
    found.inside.push_back({particle, k, std::abs(surface->distance)});
  }

  void find_crossing(Index e, Index k, Intersections& found) const {
    const Element& element = surface_.elements[static_cast<std::size_t>(e)];
    ElementCorners corners{.x = {}, .count = element.corners};
    double within = 0.0;
    int fixed = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(element.corners); ++i) {
      const Vector3 x = positions_.col(element.particles[i]);
      corners.x[i] = frame_.local(k, x);
      within = std::max(within, tolerance(x, k));
      fixed += is_fixed(surface_.motions, element.particles[i]) ? 1 : 0;
    }
    if (fixed == element.corners || !frame_.shape(k).touches(corners, within)) return;
    if (fixed == 0 || !is_fixed_in(element, k)) found.crossings.push_back({e, k});
  }

  [[nodiscard]] bool is_fixed_in(const Element& element, Index k) const {
    return std::any_of(element.particles.begin(), element.particles.begin() + element.corners, [&](Index i) {
      if (!is_fixed(surface_.motions, i)) return false;
      const Vector3 p = frame_.local(k, positions_.col(i));
      return frame_.shape(k).contains(p) || frame_.shape(k).touches({.x = {p}, .count = 1}, tolerance(positions_.col(i), k));
    });
  }

  const ObstacleFrame& frame_;
  const CollisionSurface& surface_;
  const Points& positions_;
};

}  // namespace

Intersections find_intersections(const ObstacleFrame& frame, const CollisionSurface& surface, const Points& positions, Index body) {
  if (frame.set().empty()) return {};
  const PatchSearch search(frame, surface, positions);
  std::vector<Intersections> of_patches(surface.patches.size());
  parallel_chunks(static_cast<Index>(of_patches.size()), 1, [&](Index begin, Index end) {
    for (Index p = begin; p < end; ++p) {
      const ElementPatch& patch = surface.patches[static_cast<std::size_t>(p)];
      const Index own = surface.elements[static_cast<std::size_t>(patch.first_element)].body;
      if (body == kNone || body == own) search.search(p, of_patches[static_cast<std::size_t>(p)]);
    }
  });

  Intersections all;
  for (const Intersections& patch : of_patches) {
    all.inside.insert(all.inside.end(), patch.inside.begin(), patch.inside.end());
    all.crossings.insert(all.crossings.end(), patch.crossings.begin(), patch.crossings.end());
  }
  std::sort(all.inside.begin(), all.inside.end(),
            [](const auto& a, const auto& b) { return std::pair(a.particle, a.obstacle) < std::pair(b.particle, b.obstacle); });
  std::sort(all.crossings.begin(), all.crossings.end(),
            [](const auto& a, const auto& b) { return std::pair(a.element, a.obstacle) < std::pair(b.element, b.obstacle); });
  return all;
}

}  // namespace sprung
