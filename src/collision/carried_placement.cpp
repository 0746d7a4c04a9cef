#include "collision/carried_placement.h"

namespace sprung {

namespace {

// Neighbours are carried so far around.
constexpr int kRounds = 4;

}  // namespace

void carry_squeezed(ObstacleZones& zones, const std::vector<Index>& particles, const Points& before, Points& after,
                    Outcomes& outcomes) {
  if (count(outcomes, Outcome::squeezed) == 0) return;
  std::vector<char> crossed_before(particles.size(), 0);
  std::vector<char> tried(particles.size(), 0);
  std::vector<std::size_t> group;
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (zones.is_crossed(particles[n])) crossed_before[n] = 1;
    if (outcomes[n] == Outcome::squeezed) group.push_back(n);
  }
  for (int round = 0; round < kRounds && !group.empty(); ++round) {
    std::vector<Index> carried;
    for (const std::size_t n : group) {
      const Index i = particles[n];
      const auto place = zones.carried(i, before.col(i));
      if (place) after.col(i) = *place;
      outcomes[n] = place ? Outcome::stopped : Outcome::squeezed;
      tried[n] = 1;
      carried.push_back(i);
    }
    zones.renew_around(carried, {after, after, true});
    group.clear();
    for (std::size_t n = 0; n < particles.size(); ++n) {
      if (tried[n] == 0 && crossed_before[n] == 0 && zones.is_crossed(particles[n])) group.push_back(n);
    }
  }
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (crossed_before[n] == 0 && zones.is_crossed(particles[n])) outcomes[n] = Outcome::squeezed;
  }
}

}  // namespace sprung
