#include "simulation/simulator_implementation.h"

#include <algorithm>

namespace sprung {
namespace {

bool is_free(const Body& body, const SpringNetwork& network) {
  return (network.inverse_masses.segment(body.first_particle, body.particle_count).array() > 0.0).any();
}

}  // namespace

/// External forces may change at any time, and so may wind. Bodies sink into a penalty for long, and are not at rest while they do.
void Simulator::Implementation::choose_sleepers() {
  std::ranges::fill(sleepers, 0);
  const bool may_sleep = settings.sleep && penalty == nullptr && constraints.contacts().can_collide() && external.empty() &&
                         state.feasible_steps > 0 && (!settings.has_air() || time() >= settings.wind.end());
  if (!may_sleep) {
    forget_rest();
    return;
  }
  const Islands::Found found = islands.find(state);
  std::vector<char> restless = islands.driven(found, time());
  rest.note(time(), restless, found.islands, state);
  std::optional<std::vector<ContactNormal>> normals;
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    const Body& body = network.bodies[b];
    sleepers[b] = body.asleep || state.rests[b].rests ? 1 : 0;
    if (body.asleep || restless[b] != 0 || !is_free(body, network)) continue;
    if (sleepers[b] != 0 && !normals) normals = contact_normals();
    if (sleepers[b] == 0 || !is_still(body, *normals)) restless[b] = 1;
  }
  restless = with_islands(restless, found.islands);
  for (std::size_t b = 0; b < restless.size(); ++b) {
    if (restless[b] != 0 || (!network.bodies[b].asleep && !is_free(network.bodies[b], network))) sleepers[b] = 0;
  }
}

void Simulator::Implementation::forget_rest() {
  state.x_at_rest.resize(3, 0);
  state.rests.clear();
}

/// Whether a body touches something and does not stand on its edge. Without contact nothing sleeps: a pendulum is slow at the end
/// of each swing.
bool Simulator::Implementation::is_still(const Body& body, const std::vector<ContactNormal>& normals) const {
  std::vector<ContactNormal> own;
  std::ranges::copy_if(normals, std::back_inserter(own), [&](const ContactNormal& contact) {
    return contact.particle >= body.first_particle && contact.particle < body.first_particle + body.particle_count;
  });
  return !own.empty() && !(symmetry && symmetry->has_standing(own, state.x));
}

/// Whether a step changes nothing but the time: some bodies sleep, and pins hold all others at rest.
bool Simulator::Implementation::all_sleep() const {
  bool any = false;
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    const Body& body = network.bodies[b];
    any = any || body.asleep;
    if (!body.asleep && (is_free(body, network) || time() < islands.end_of_motions(b))) return false;
  }
  return any;
}

/// After each step: bodies that sleep repeat what their last step recorded.
void Simulator::Implementation::repeat_impulses(const RecordedImpulses& before) {
  if (!state.impulses.on()) return;
  RecordedImpulses& last = state.last_impulses;
  const bool all = all_sleep();
  for (const Body& body : network.bodies) {
    const auto particles = Eigen::seqN(body.first_particle, body.particle_count);
    const auto springs = Eigen::seqN(body.first_spring, body.spring_count);
    if (body.asleep || all) {
      state.impulses.on_pinned(Eigen::all, particles) =
          before.on_pinned(Eigen::all, particles) + last.on_pinned(Eigen::all, particles);
      state.impulses.of_springs(springs) = before.of_springs(springs) + last.of_springs(springs);
    } else {
      last.on_pinned(Eigen::all, particles) =
          state.impulses.on_pinned(Eigen::all, particles) - before.on_pinned(Eigen::all, particles);
      last.of_springs(springs) = state.impulses.of_springs(springs) - before.of_springs(springs);
    }
  }
}

/// Bodies that fall asleep or wake have no speed.
void Simulator::Implementation::take_sleep(const Implementation& before) {
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    const Body& body = network.bodies[b];
    if (body.asleep == before.network.bodies[b].asleep) continue;
    if (!state.rests.empty()) state.rests[b] = {};
    for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
      state.v.col(i).setZero();
      if (!network.is_pinned(i)) integrator->velocity_changed(state, i, before.dt());
    }
  }
  std::ranges::copy_if(before.contacts(), std::back_inserter(contacts_asleep),
                       [&](Index particle) { return network.body_of(particle).asleep; });
}

}  // namespace sprung
