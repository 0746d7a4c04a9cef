#include "dynamics/forces/material_dampers.h"
#include "geometry/mesh/union_find.h"
#include "simulation/stepper.h"

#include <algorithm>

namespace sprung {

bool Stepper::sleeps(Index group) const { return network().is_asleep(groups().groups[group].particles.front()); }

/// Whether the group has a particle that is not pinned. It may sleep.
bool Stepper::is_free(Index group) const {
  return sleeps(group) || std::ranges::any_of(groups().groups[group].particles, [&](Index i) { return !network().is_fixed(i); });
}

std::vector<char> Stepper::sleeping_groups() const {
  std::vector<char> asleep;
  for (Index p = 0; p < groups().count(); ++p) asleep.push_back(sleeps(p) ? 1 : 0);
  return asleep;
}

/// Whether each particle sleeps in the next step; empty: none does.
std::vector<char> Stepper::particles_to_sleep() const {
  std::vector<char> asleep;
  if (std::ranges::count(state_.rest.sleepers, 0) == static_cast<std::ptrdiff_t>(state_.rest.sleepers.size())) return asleep;
  for (const Index p : groups().group_of) asleep.push_back(state_.rest.sleepers[p]);
  return asleep;
}

/// Nothing sleeps
/// - with penalty contact, into which bodies sink for a long time;
/// - while a force that a program added may act on any particle, as it may change at any time;
/// - before the wind stays the same, if it acts on a body. Still air never changes;
/// - in scenes without contact and without a body whose springs have the dampers of a material. Their small motions may be what the
///   scene measures.
bool Stepper::may_sleep() const {
  return settings().sleep && work().penalty == nullptr && !work().touches_any && state_.planner.feasible_steps > 0 &&
         (constraints().contacts().can_collide() || has_material_dampers(network())) &&
         (time() >= settings().wind.end() || !(settings().has_air() || has_own_drag(network())));
}

/// Call it after each step. A restless group wakes its neighbours. Groups fall asleep at the end of a window.
void Stepper::choose_sleepers() {
  if (!may_sleep()) {
    wake_all();
    return;
  }
  work().rest.observe(time(), state_);
  const bool window_ends = RestDetector::window_ends(time(), state_);
  if (network().activity.asleep.empty() && !window_ends) return;
  const Surroundings::Found found = work().surroundings.find(state_);
  const std::vector<char> asleep = sleeping_groups();
  std::vector<char> restless = work().rest.restless(state_);
  const std::vector<char> driven = work().surroundings.driven(found, time());
  for (std::size_t p = 0; p < restless.size(); ++p)
    restless[p] = restless[p] != 0 || driven[p] != 0 || work().touched_groups[p] != 0 ? 1 : 0;
  const std::vector<char> disturbed = with_neighbours(restless, found.pairs);
  for (std::size_t p = 0; p < state_.rest.sleepers.size(); ++p)
    state_.rest.sleepers[p] = asleep[p] != 0 && disturbed[p] == 0 ? 1 : 0;
  if (window_ends) {
    work().rest.end_window(time(), restless, with_neighbours(asleep, found.pairs), state_);
    add_sleepers(found, disturbed);
  }
  wake_with_bodies(asleep);
}

void Stepper::wake_all() {
  std::ranges::fill(state_.rest.sleepers, 0);
  RestDetector::forget(state_);
}

void Stepper::wake_driven() {
  const std::vector<char> asleep = sleeping_groups();
  if (std::ranges::count(asleep, 0) == static_cast<std::ptrdiff_t>(asleep.size())) return;
  const Surroundings::Found found = work().surroundings.find(state_);
  const std::vector<char> driven = with_neighbours(work().surroundings.driven(found, time()), found.pairs);
  for (std::size_t p = 0; p < driven.size(); ++p) {
    if (driven[p] != 0) state_.rest.sleepers[p] = 0;
  }
  wake_with_bodies(asleep);
}

/// A group at rest falls asleep if its neighbours are at rest too, if its body settles, and if something holds it: see
/// settling_bodies() and held_groups(). A group is held too if it is connected through
/// neighbours to a held group or to a sleeper.
void Stepper::add_sleepers(const Surroundings::Found& found, const std::vector<char>& disturbed) {
  std::vector<char> awake;
  for (Index p = 0; p < groups().count(); ++p)
    awake.push_back(!sleeps(p) && is_free(p) && !state_.rest.histories[p].is_at_rest ? 1 : 0);
  const std::vector<char> beside_awake = with_neighbours(awake, found.pairs);
  std::vector<char> candidates = state_.rest.sleepers;
  for (Index p = 0; p < groups().count(); ++p) {
    if (!sleeps(p) && is_free(p) && disturbed[p] == 0 && beside_awake[p] == 0) candidates[p] = 1;
  }
  UnionFind joined(groups().count());
  const auto joins = [&](Index p) { return candidates[p] != 0 || !is_free(p); };
  for (const auto& [a, b] : found.pairs) {
    if (joins(a) && joins(b)) joined.join(a, b);
  }
  const std::vector<char> holds = held_groups(found);
  std::vector<char> held(candidates.size(), 0);  // by root
  for (Index p = 0; p < groups().count(); ++p) {
    if (holds[p] != 0 || state_.rest.sleepers[p] != 0) held[joined.root(p)] = 1;
  }
  const std::vector<char> settling = settling_bodies();
  for (Index p = 0; p < groups().count(); ++p) {
    const bool begins = candidates[p] != 0 && settling[groups().groups[p].body] != 0 && held[joined.root(p)] != 0;
    if (begins) state_.rest.sleepers[p] = 1;
  }
}

/// Whether each group is held by a pin, by an attachment to an obstacle, or by an obstacle that it touches. What nothing holds
/// falls, and is slow only at the top of its path. Where neither gravity nor wind acts, nothing needs to be held.
std::vector<char> Stepper::held_groups(const Surroundings::Found& found) const {
  const bool has_wind = !settings().wind.is_calm() && (settings().has_air() || has_own_drag(network()));
  std::vector<char> held(found.boxes.size(), settings().gravity.isZero(0.0) && !has_wind ? 1 : 0);
  for (Index i = 0; i < network().particle_count(); ++i) {
    if (network().activity.is_pinned(i)) held[groups().group_of[i]] = 1;
  }
  for (const Link& link : state_.links) {
    if (link.second.front() == kNone && !link.broken) held[groups().group_of[link.first]] = 1;
  }
  const std::vector<char> beside = work().surroundings.beside_obstacles(found, time());
  for (const ContactNormal& contact : contact_normals()) {
    const Index p = groups().group_of[contact.particle];
    held[p] |= beside[p];
  }
  return held;
}

/// Whether each body settles: its springs have the dampers of a material, or it touches something. A body that stands on its edge
/// does not.
std::vector<char> Stepper::settling_bodies() const {
  std::vector<std::vector<ContactNormal>> contacts(network().bodies.size());
  for (const ContactNormal& contact : contact_normals()) {
    contacts[groups().groups[groups().group_of[contact.particle]].body].push_back(contact);
  }
  std::vector<char> settling;
  for (std::size_t b = 0; b < contacts.size(); ++b) {
    const bool stands = structure().symmetry && !contacts[b].empty() && structure().symmetry->has_standing(contacts[b], state_.x);
    settling.push_back(!stands && (!contacts[b].empty() || has_material_dampers(network().bodies[b])) ? 1 : 0);
  }
  return settling;
}

/// If a group of `asleep` wakes, its whole body wakes: it may have lost its support. A group that an attachment joins to a free
/// group sleeps only if the free group sleeps.
void Stepper::wake_with_bodies(const std::vector<char>& asleep) {
  std::vector<char> woken(network().bodies.size(), 0);
  bool changes = true;
  while (changes) {
    changes = false;
    for (Index p = 0; p < groups().count(); ++p) {
      if (asleep[p] != 0 && state_.rest.sleepers[p] == 0) woken[groups().groups[p].body] = 1;
    }
    const auto wake = [&](Index p) {
      changes = changes || state_.rest.sleepers[p] != 0;
      state_.rest.sleepers[p] = 0;
    };
    for (Index p = 0; p < groups().count(); ++p) {
      if (woken[groups().groups[p].body] != 0) wake(p);
    }
    for (const auto& [a, b] : work().surroundings.attached()) {
      if (state_.rest.sleepers[a] == 0 && is_free(a)) wake(b);
      if (state_.rest.sleepers[b] == 0 && is_free(b)) wake(a);
    }
  }
}

/// Whether the step made a neighbour of a sleeping group restless. Removes the group from the sleepers of the state then: the step
/// has to be made again without it.
bool Stepper::disturbs_sleep(const std::vector<GroupPair>& pairs) {
  if (network().activity.asleep.empty()) return false;
  const std::vector<char> asleep = sleeping_groups();
  const std::vector<char> disturbed = with_neighbours(work().rest.restless(state_), pairs);
  for (std::size_t p = 0; p < state_.rest.sleepers.size(); ++p)
    state_.rest.sleepers[p] = asleep[p] != 0 && disturbed[p] == 0 ? 1 : 0;
  wake_with_bodies(asleep);
  return state_.rest.sleepers != asleep;
}

/// Whether a step changes nothing but the time: some groups sleep, and pins hold all others at rest.
bool Stepper::all_sleep() const {
  bool any = false;
  for (Index p = 0; p < groups().count(); ++p) {
    const bool asleep = sleeps(p);
    any = any || asleep;
    if (!asleep && (is_free(p) || time() < work().surroundings.end_of_motions(p))) return false;
  }
  return any;
}

/// Adds the last recorded impulses of sleeping particles again.
void Stepper::add_impulses_of_sleepers(const RecordedImpulses& before) {
  RecordedImpulses& last = state_.last_impulses;
  const bool all = all_sleep();
  for (const auto member : {&RecordedImpulses::on_pinned, &RecordedImpulses::of_contact}) {
    Points& now = state_.impulses.*member;
    for (Index i = 0; i < now.cols(); ++i) {
      if (all || network().is_asleep(i)) {
        now.col(i) = (before.*member).col(i) + (last.*member).col(i);
      } else {
        (last.*member).col(i) = now.col(i) - (before.*member).col(i);
      }
    }
  }
  if (!state_.impulses.on()) return;
  const Springs& springs = network().springs;
  for (Index s = 0; s < springs.count(); ++s) {
    if (all || (network().is_asleep(springs.first[s]) && network().is_asleep(springs.second[s]))) {
      state_.impulses.of_springs[s] = before.of_springs[s] + last.of_springs[s];
    } else {
      last.of_springs[s] = state_.impulses.of_springs[s] - before.of_springs[s];
    }
  }
}

}  // namespace sprung
