#include "geometry/mesh/union_find.h"
#include "network/model/sleeping_particles.h"
#include "simulation/simulator_implementation.h"

#include <algorithm>

namespace sprung {

bool Simulator::Implementation::is_asleep(Index patch) const { return network.is_asleep(patches.patches[patch].particles.front()); }

bool Simulator::Implementation::is_free(Index patch) const {
  return std::ranges::any_of(patches.patches[patch].particles, [&](Index i) { return !network.is_pinned(i); });
}

std::vector<char> Simulator::Implementation::sleeping_patches() const {
  std::vector<char> asleep;
  for (Index p = 0; p < patches.count(); ++p) asleep.push_back(is_asleep(p) ? 1 : 0);
  return asleep;
}

/// Whether each particle sleeps in the next step.
std::vector<char> Simulator::Implementation::particles_to_sleep() const {
  std::vector<char> asleep;
  for (const Index p : patches.patch_of) asleep.push_back(sleepers[p]);
  return asleep;
}

/// External forces may change at any time, and so may wind. Bodies sink into a penalty for long, and are not at rest while they do.
bool Simulator::Implementation::may_sleep() const {
  return settings.sleep && penalty == nullptr && constraints.contacts().can_collide() && external.empty() &&
         state.feasible_steps > 0 && (!settings.has_air() || time() >= settings.wind.end());
}

/// After each step. What sleeps goes on while no neighbour is restless. Patches fall asleep at the end of a window.
void Simulator::Implementation::choose_sleepers() {
  if (!may_sleep()) {
    std::ranges::fill(sleepers, 0);
    RestDetector::forget(state);
    return;
  }
  const Surroundings::Found found = surroundings.find(state);
  const std::vector<char> asleep = sleeping_patches();
  std::vector<char> restless = surroundings.driven(found, time());
  const std::vector<char> undriven = rest.restless(state);
  for (std::size_t p = 0; p < restless.size(); ++p) restless[p] = restless[p] != 0 || undriven[p] != 0 ? 1 : 0;
  const bool window_ended = rest.note(time(), restless, with_neighbours(asleep, found.pairs), state);
  const std::vector<char> disturbed = with_neighbours(restless, found.pairs);
  for (Index p = 0; p < patches.count(); ++p) sleepers[p] = asleep[p] != 0 && disturbed[p] == 0 ? 1 : 0;
  if (window_ended) add_sleepers(found.pairs, disturbed);
}

/// A patch at rest falls asleep if its neighbours are at rest too, and if it or a patch of its body with which it is joined through
/// others that sleep touches something. Without contact nothing sleeps: a pendulum is slow at the end of each swing.
void Simulator::Implementation::add_sleepers(const std::vector<PatchPair>& pairs, const std::vector<char>& disturbed) {
  std::vector<char> awake;
  for (Index p = 0; p < patches.count(); ++p) awake.push_back(!is_asleep(p) && is_free(p) && !state.rests[p].rests ? 1 : 0);
  const std::vector<char> beside_awake = with_neighbours(awake, pairs);
  std::vector<char> supported = sleepers;
  std::vector<char> may_sleep = sleepers;
  bool any = false;
  for (Index p = 0; p < patches.count(); ++p) {
    if (sleepers[p] != 0 || !is_free(p) || disturbed[p] != 0 || beside_awake[p] != 0) continue;
    may_sleep[p] = 1;
    any = true;
  }
  if (!any) return;
  for (const ContactNormal& contact : steady_contacts()) supported[patches.patch_of[contact.particle]] = 1;
  UnionFind joined(patches.count());
  for (const auto& [a, b] : patches.adjacent) {
    if (may_sleep[a] != 0 && may_sleep[b] != 0) joined.join(a, b);
  }
  std::vector<char> rests_on_something(supported.size(), 0);  // by root
  for (Index p = 0; p < patches.count(); ++p) {
    if (may_sleep[p] != 0 && supported[p] != 0) rests_on_something[joined.root(p)] = 1;
  }
  for (Index p = 0; p < patches.count(); ++p) {
    if (may_sleep[p] != 0 && rests_on_something[joined.root(p)] != 0) sleepers[p] = 1;
  }
}

/// Without those of bodies that stand on their edge.
std::vector<ContactNormal> Simulator::Implementation::steady_contacts() const {
  std::vector<ContactNormal> steady;
  const std::vector<ContactNormal> all = contact_normals();
  for (const Body& body : network.bodies) {
    std::vector<ContactNormal> own;
    std::ranges::copy_if(all, std::back_inserter(own), [&](const ContactNormal& contact) {
      return contact.particle >= body.first_particle && contact.particle < body.first_particle + body.particle_count;
    });
    if (!symmetry || !symmetry->has_standing(own, state.x)) steady.insert(steady.end(), own.begin(), own.end());
  }
  return steady;
}

/// Whether a neighbour of a patch that sleeps is restless after the step: then it has to be made again without that sleep.
bool Simulator::Implementation::disturbs_sleepers(const std::vector<PatchPair>& pairs) {
  const std::vector<char> disturbed = with_neighbours(rest.restless(state), pairs);
  bool any = false;
  for (Index p = 0; p < patches.count(); ++p) {
    any = any || (sleepers[p] != 0 && disturbed[p] != 0);
    if (disturbed[p] != 0) sleepers[p] = 0;
  }
  return any;
}

/// Whether a step changes nothing but the time: some patches sleep, and pins hold all others at rest.
bool Simulator::Implementation::all_sleep() const {
  bool any = false;
  for (Index p = 0; p < patches.count(); ++p) {
    const bool asleep = is_asleep(p);
    any = any || asleep;
    if (!asleep && (is_free(p) || time() < surroundings.end_of_motions(p))) return false;
  }
  return any;
}

/// After each step: what sleeps repeats what its last step recorded.
void Simulator::Implementation::repeat_impulses(const RecordedImpulses& before) {
  if (!state.impulses.on()) return;
  RecordedImpulses& last = state.last_impulses;
  const bool all = all_sleep();
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (all || network.is_asleep(i)) {
      state.impulses.on_pinned.col(i) = before.on_pinned.col(i) + last.on_pinned.col(i);
    } else {
      last.on_pinned.col(i) = state.impulses.on_pinned.col(i) - before.on_pinned.col(i);
    }
  }
  const Springs& springs = network.springs;
  for (Index s = 0; s < springs.count(); ++s) {
    if (all || (network.is_asleep(springs.first[s]) && network.is_asleep(springs.second[s]))) {
      state.impulses.of_springs[s] = before.of_springs[s] + last.of_springs[s];
    } else {
      last.of_springs[s] = state.impulses.of_springs[s] - before.of_springs[s];
    }
  }
}

/// What falls asleep or wakes has no speed. What wakes does not rest in the present window.
void Simulator::Implementation::take_sleep(const Implementation& before) {
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.is_asleep(i) == before.network.is_asleep(i)) continue;
    if (!state.rests.empty() && !network.is_asleep(i)) state.rests[patches.patch_of[i]] = {.is_unsettled = true};
    state.v.col(i).setZero();
    if (!network.is_pinned(i)) integrator->velocity_changed(state, i, before.dt());
  }
  std::ranges::copy_if(before.contacts(), std::back_inserter(contacts_asleep),
                       [&](Index particle) { return network.is_asleep(particle); });
}

}  // namespace sprung
