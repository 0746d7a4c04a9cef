// The members of a state, for comparisons, hashes and files (see base/binary_archive.h).
#pragma once

#include "base/files/binary_archive.h"
#include "dynamics/state/simulation_state.h"

namespace sprung {

template <Same<PlannerMemory> S, class Visit>
void visit_members(S& m, const Visit& visit) {
  visit(m.reason, m.calm_steps, m.feasible_steps, m.retry_from, m.retry_wait, m.retry_infeasible);
}
template <Same<Activity> S, class Visit>
void visit_members(S& a, const Visit& visit) {
  visit(a.phases, a.pin_of, a.asleep);
}
template <Same<Unloading> S, class Visit>
void visit_members(S& u, const Visit& visit) {
  visit(u.by_all, u.by_near, u.by_recoil, u.is_at_tear);
}
template <Same<SpringState> S, class Visit>
void visit_members(S& s, const Visit& visit) {
  visit(s.rest_lengths, s.broken, s.unloading);
}
/// Pins that a program added: they neither move nor end.
template <Same<Pin> S, class Visit>
void visit_members(S& p, const Visit& visit) {
  visit(p.name, p.particles, p.origin, p.from);
}
template <Same<TimedPose> S, class Visit>
void visit_members(S& p, const Visit& visit) {
  visit(p.time, p.pose);
}
template <Same<SteeredMotion> S, class Visit>
void visit_members(S& m, const Visit& visit) {
  visit(m.number, m.poses);
}
template <Same<Steering> S, class Visit>
void visit_members(S& s, const Visit& visit) {
  visit(s.added_pins, s.pins, s.obstacles);
}
template <Same<ContactNormal> S, class Visit>
void visit_members(S& n, const Visit& visit) {
  visit(n.particle, n.normal);
}
template <Same<PermittedCrossing> S, class Visit>
void visit_members(S& c, const Visit& visit) {
  visit(c.obstacle, c.particle);
}
template <Same<Slip> S, class Visit>
void visit_members(S& s, const Visit& visit) {
  visit(s.displacement, s.obstacle);
}
template <Same<ContactMemory> S, class Visit>
void visit_members(S& c, const Visit& visit) {
  visit(c.slip, c.pushed, c.normals, c.permitted_crossings);
}
template <Same<MotionHistory> S, class Visit>
void visit_members(S& h, const Visit& visit) {
  visit(h.in_frame, h.was_invisible, h.is_at_rest);
}
template <Same<RestMemory> S, class Visit>
void visit_members(S& r, const Visit& visit) {
  visit(r.window_begin, r.frames, r.x_at_frame, r.x_at_begins, r.x_beside_sleep, r.histories, r.sleepers);
}
template <Same<EnergyMemory> S, class Visit>
void visit_members(S& e, const Visit& visit) {
  visit(e.start, e.highest_gravity, e.stored, e.max_kinetic, e.fastest_drive, e.is_stale);
}
template <Same<StretchHandover> S, class Visit>
void visit_members(S& h, const Visit& visit) {
  visit(h.missed_steps, h.patience, h.solved_since);
}
template <Same<LimitMemory> S, class Visit>
void visit_members(S& l, const Visit& visit) {
  visit(l.handovers);
}
template <Same<PinGrip> S, class Visit>
void visit_members(S& g, const Visit& visit) {
  visit(g.particle, g.from, g.time, g.position, g.triangle);
}
template <Same<Link> S, class Visit>
void visit_members(S& l, const Visit& visit) {
  visit(l.attachment, l.first, l.second, l.weights, l.triangle, l.anchor, l.distance, l.length, l.time, l.broken, l.impulse);
}
template <Same<RecordedImpulses> S, class Visit>
void visit_members(S& i, const Visit& visit) {
  visit(i.on_pinned, i.of_springs, i.of_contact);
}
template <Same<ReactionMemory> S, class Visit>
void visit_members(S& r, const Visit& visit) {
  visit(r.impulses, r.since);
}
template <Same<SimulationState> S, class Visit>
void visit_members(S& s, const Visit& visit) {
  visit(s.step, s.frame, s.step_in_frame, s.steps_per_frame, s.substeps, s.substep, s.step_length, s.integrator, s.planner, s.x,
        s.v, s.x_previous, s.activity, s.springs, s.steering, s.contact, s.rest, s.energy, s.limit, s.grips, s.links, s.impulses,
        s.last_impulses, s.reactions, s.added_forces, s.added_constraints);
}

}  // namespace sprung
