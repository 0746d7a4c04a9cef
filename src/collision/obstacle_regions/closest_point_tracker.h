// When the closest points of an element and an obstacle have to be searched again.
#pragma once

#include "collision/safe_regions/safe_region.h"

#include <array>
#include <vector>

namespace sprung {

/// Records, for each element of a patch, where it was when its closest points were searched last. All positions [m] are in the
/// obstacle's frame.
class ClosestPointTracker {
 public:
  enum class Search : char {
    none,           ///< the known points are still good
    same_triangle,  ///< search on the obstacle's triangle that is known
    whole_surface   ///< search on all of the obstacle
  };

  explicit ClosestPointTracker(std::size_t element_count) : records_(element_count) {}

  /// The whole surface was searched with the element's corners here.
  void reset(Index element, const std::array<Vector3, 3>& corners) {
    records_[static_cast<std::size_t>(element)] = {.corners = corners};
  }

  /// The search that the element needs: none until it has moved by a small fraction of `gap` [m], the whole surface once its
  /// displacements since the last such search add up to `gap`. `drift` [m] is the displacement of the surface at the closest point
  /// in this interval. `is_round` as of ObstacleShape. The caller makes the search that is returned, then calls set_corners().
  [[nodiscard]] Search next_search(Index element, const ElementCorners& corners, const Vector3& drift, double gap, bool is_round);

  /// Records where the element was in the search that next_search() requested.
  void set_corners(Index element, const std::array<Vector3, 3>& corners) {
    records_[static_cast<std::size_t>(element)].corners = corners;
  }

  /// Moves the record with a deforming surface [m].
  void shift(Index element, const Vector3& drift);

 private:
  struct Record {
    std::array<Vector3, 3> corners;  ///< at the last search
    double travelled = 0.0;          ///< sum of displacements since the last search on the whole surface [m]
  };

  std::vector<Record> records_;  ///< by element
};

}  // namespace sprung
