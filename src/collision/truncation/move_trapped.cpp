#include "collision/truncation/move_trapped.h"

namespace sprung {

namespace {

// Elements that are crossed then are taken along as wholes, and what they meet there; if that does not free them, somewhat higher
// each time.
constexpr double kLifts[] = {0.0, 0.0, 1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0};

}  // namespace

void move_infeasible(ObstacleSafeRegions& regions, const std::vector<Index>& particles, const Points& before, Points& after,
                     Outcomes& outcomes) {
  if (count(outcomes, Outcome::infeasible) == 0) return;
  std::vector<std::size_t> number(static_cast<std::size_t>(after.cols()), particles.size());
  std::vector<char> crossed_before(particles.size(), 0);
  std::vector<Index> carried;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    const Index i = particles[n];
    number[static_cast<std::size_t>(i)] = n;
    crossed_before[n] = regions.is_crossed(i) ? 1 : 0;
    if (outcomes[n] != Outcome::infeasible) continue;
    const auto place = regions.carried(i, before.col(i));
    if (!place) continue;
    after.col(i) = *place;
    outcomes[n] = Outcome::stopped;
    carried.push_back(i);
  }
  regions.renew_around(carried, {after, after, true});
  for (const double lift : kLifts) {
    if (carried.empty()) break;
    carried.clear();
    for (const auto& [i, distance, place] : regions.carried_with_elements(before, lift)) {
      const std::size_t n = number[static_cast<std::size_t>(i)];
      if (n == particles.size() || crossed_before[n] != 0) continue;
      after.col(i) = place;
      outcomes[n] = Outcome::stopped;
      carried.push_back(i);
    }
    regions.renew_around(carried, {after, after, true});
  }
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (crossed_before[n] == 0 && regions.is_crossed(particles[n])) outcomes[n] = Outcome::infeasible;
  }
}

}  // namespace sprung
