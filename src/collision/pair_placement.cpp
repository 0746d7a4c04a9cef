#include "collision/pair_placement.h"

#include "base/parallel.h"
#include "collision/feasible_point.h"

#include <array>

namespace sprung {

namespace {

constexpr Index kParticleChunk = 256;

Outcome place_held(const ObstacleZones& zones, const SelfZones& pairs, Index particle, const Vector3& before, const Vector3& target,
                   Points& after) {
  if (pairs.allows(particle, target)) return Outcome::free;
  std::vector<HalfSpace> bounds;
  zones.append_half_spaces(particle, bounds);
  pairs.append_half_spaces(particle, bounds);
  const Vector3 apart = pairs.safe_place(particle);
  const std::array<Vector3, 2> safe{apart, before};
  auto found = feasible_point(bounds, target, safe);
  if (found) {
    const auto [centre, radius] = pairs.ball(particle);
    const double distance = (*found - centre).norm();
    if (distance > radius) *found = centre + radius / distance * (*found - centre);
  }
  if (found && pairs.allows(particle, *found) && zones.allow(particle, *found)) {
    after.col(particle) = *found;
    return Outcome::stopped;
  }
  after.col(particle) = apart;
  return zones.allow(particle, apart) ? Outcome::stopped : Outcome::squeezed;
}

}  // namespace

Outcomes place_apart(const ObstacleZones& zones, SelfZones& pairs, const Points& before, Points& after) {
  const Points targets = after;
  const std::vector<Index> held = pairs.hold(before, targets, zones.carried(before));
  Outcomes outcomes(held.size());
  parallel_chunks(static_cast<Index>(held.size()), kParticleChunk, [&](Index begin, Index end) {
    for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
      outcomes[n] = place_held(zones, pairs, held[n], before.col(held[n]), targets.col(held[n]), after);
    }
  });
  return outcomes;
}

}  // namespace sprung
