#include "collision/truncation.h"

#include "collision/particle_blocks.h"

#include <algorithm>

namespace sprung {

namespace {

// A cut path keeps this part of its begin's distance from the plane that it would have crossed, but at least its clearance.
constexpr double kKeptDistance = 0.125;

// Cuts by one obstacle may run into another: each round makes the path shorter.
constexpr int kRounds = 8;

struct Blocked {
  Index obstacle = kNone;
  Crossing crossing;
  LocalPath path;
  double clearance = 0.0;
};

/// The first of the near obstacles that the path to `target` crosses.
std::optional<Blocked> find_blocked(const ObstacleSet& set, const std::vector<Index>& near, const Vector3& from,
                                    const Vector3& target) {
  for (const Index k : near) {
    const LocalPath path = set.local_path(k, from, target);
    if (const auto crossing = set.shape(k).first_crossing(path.begin, path.end)) {
      return Blocked{k, *crossing, path, set.clearance(k, from, target)};
    }
  }
  return std::nullopt;
}

/// A position before the crossing, in the world at the interval's end. Where the begin is so near that nothing is left to cut, it
/// stays with the obstacle; one that moves would wear its height away, a rounding a step, and so gives back what is missing.
Vector3 cut(const ObstacleSet& set, const Vector3& from, const Blocked& blocked) {
  const auto& [k, crossing, path, clearance] = blocked;
  const double height = crossing.normal.dot(path.begin - crossing.point);
  if (height <= 2.0 * clearance) {
    if (height >= clearance || set.rests(k)) return set.carried(k, from);
    return set.after(k) * (path.begin + (clearance - height) * crossing.normal);
  }
  const double kept = std::max(kKeptDistance, clearance / height);
  return set.after(k) * (path.begin + (1.0 - kept) * crossing.fraction * (path.end - path.begin));
}

/// Where a particle may go instead of `target`; `free` tells whether any obstacle is still crossed there.
struct Place {
  Vector3 position;
  bool free = true;
  bool moved = false;
};

Place find_place(const ObstacleSet& set, const std::vector<Index>& near, const Vector3& from, const Vector3& target) {
  Place place{.position = target};
  std::vector<Index> met;
  for (int round = 0; round < kRounds; ++round) {
    const auto blocked = find_blocked(set, near, from, place.position);
    if (!blocked) return place;
    place.position = cut(set, from, *blocked);
    place.moved = true;
    met.push_back(blocked->obstacle);
  }
  // Obstacles that close in on the particle from several sides: staying with one of them may be free of the others.
  for (const Index k : met) {
    place.position = set.carried(k, from);
    if (!find_blocked(set, near, from, place.position)) return place;
  }
  place.free = false;
  return place;
}

}  // namespace

std::vector<Index> truncate_paths(const ObstacleSet& set, const Points& before, Points& after, const std::vector<char>& held,
                                  Index& squeezed) {
  struct Moved {
    Index particle;
    bool free;
  };
  squeezed = 0;
  if (set.obstacles().empty()) return {};
  const auto count = static_cast<Index>(before.cols());
  const double carried = set.carries_at_most(before);

  const auto moved = collect_from_blocks<Moved>(count, [&](Index begin, Index end, std::vector<Moved>& results) {
    const Box3 box = finite_bounds(before, begin, end).merged(finite_bounds(after, begin, end));
    if (box.isEmpty()) return;
    std::vector<Index> near;
    // Once for the path in the frame of an obstacle that comes, once more where another has carried the particle.
    set.find_near(grown(box, 2.0 * carried), near);
    if (near.empty()) return;
    for (Index i = begin; i < end; ++i) {
      const Vector3 from = before.col(i);
      const Vector3 target = after.col(i);
      if (held[static_cast<std::size_t>(i)] != 0 || !from.allFinite() || !target.allFinite()) continue;
      const Place place = find_place(set, near, from, target);
      if (!place.moved) continue;
      after.col(i) = place.position;
      results.push_back({i, place.free});
    }
  });

  std::vector<Index> particles;
  particles.reserve(moved.size());
  for (const Moved& result : moved) {
    particles.push_back(result.particle);
    if (!result.free) ++squeezed;
  }
  return particles;
}

}  // namespace sprung
