#include "collision/truncation/move_trapped.h"

namespace sprung {

namespace {

// Crossed elements move with the obstacle as a whole; then the elements that they cross there do too. Elements that are still
// crossed move higher above the obstacle in each round.
constexpr double kLifts[] = {0.0, 0.0, 1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0};

}  // namespace

void move_infeasible(ObstacleSafeRegions& regions, const ObstacleFrame& obstacles, const std::vector<Index>& particles,
                     const Points& before, Points& after, Outcomes& outcomes) {
  if (count(outcomes, Outcome::infeasible) == 0) return;
  const ObstacleMotion motion(regions, obstacles);
  std::vector<std::size_t> number(static_cast<std::size_t>(after.cols()), particles.size());
  std::vector<char> crossed_before(particles.size(), 0);
  std::vector<Index> moved;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    const Index i = particles[n];
    number[static_cast<std::size_t>(i)] = n;
    crossed_before[n] = regions.is_crossed(i) ? 1 : 0;
    if (outcomes[n] != Outcome::infeasible) continue;
    const auto position = motion.moved(i, before.col(i));
    if (!position) continue;
    after.col(i) = *position;
    outcomes[n] = Outcome::stopped;
    moved.push_back(i);
  }
  regions.renew_around(moved, {obstacles, after, after, true});
  for (const double lift : kLifts) {
    if (moved.empty()) break;
    moved.clear();
    for (const auto& [i, distance, position] : motion.moved_with_elements(before, lift)) {
      const std::size_t n = number[static_cast<std::size_t>(i)];
      if (n == particles.size() || crossed_before[n] != 0) continue;
      after.col(i) = position;
      outcomes[n] = Outcome::stopped;
      moved.push_back(i);
    }
    regions.renew_around(moved, {obstacles, after, after, true});
  }
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (crossed_before[n] == 0 && regions.is_crossed(particles[n])) outcomes[n] = Outcome::infeasible;
  }
}

}  // namespace sprung
