#include "collision/truncation/time_subdivision.h"

#include <algorithm>

namespace sprung {

namespace {

constexpr double kMinFraction = 1.0 / 64.0;

}  // namespace

// The loop ends: each round either halves the substep, at most six times, or finishes at least 1/64 of the interval.
Outcomes clip_in_substeps(const StepPaths& paths, Points& after, const ClipSubstep& clip) {
  const double begin = paths.obstacles.begin();
  const double end = paths.obstacles.end();
  const auto time = [&](double fraction) { return fraction < 1.0 ? begin + fraction * (end - begin) : end; };
  Outcomes outcomes;
  Points from = paths.from;
  double done = 0.0;
  double fraction = 0.5;
  while (done < 1.0) {
    const double next = std::min(1.0, done + fraction);
    const ObstacleFrame obstacles = paths.obstacles.part(time(done), time(next));
    const Points to = next < 1.0 ? Points(from + (next - done) / (1.0 - done) * (paths.to - from)) : paths.to;
    after = to;
    auto [of_substep, path_checked] = clip({obstacles, from, to}, after);
    if (fraction > kMinFraction && (!path_checked || count(of_substep, Outcome::infeasible) > 0)) {
      fraction *= 0.5;
      continue;
    }
    keep_infeasible(outcomes, of_substep);
    outcomes = std::move(of_substep);
    from = after;
    done = next;
  }
  return outcomes;
}

}  // namespace sprung
