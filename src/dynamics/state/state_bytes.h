// The members of a state as a sequence of bytes.
#pragma once

#include "base/types.h"
#include "dynamics/state/simulation_state.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace sprung {

/// Writes all numbers of a state to `sink(const void* data, std::size_t size)`, in a fixed order, and the number of entries of each
/// list before the list. Two states write the same bytes if and only if they are equal bit by bit.
template <class Sink>
class StateBytes {
 public:
  explicit StateBytes(Sink sink) : sink_(std::move(sink)) {}

  void write(const SimulationState& s) {
    all(s.step, s.frame, s.step_in_frame, s.steps_per_frame, s.substeps, s.substep, s.step_length, s.integrator, s.planner, s.x,
        s.v, s.x_previous, s.activity, s.springs, s.steering, s.contact, s.rest, s.energy, s.limit.handovers, s.grips, s.links,
        s.impulses, s.last_impulses, s.reactions.impulses, s.reactions.since, s.added_forces, s.added_constraints);
  }

 private:
  template <class... Members>
  void all(const Members&... members) {
    (write(members), ...);
  }

  template <class Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
  void write(const Number& number) { sink_(&number, sizeof(number)); }
  void write(const std::string& text) {
    write(text.size());
    sink_(text.data(), text.size());
  }
  template <class Derived>
  void write(const Eigen::PlainObjectBase<Derived>& matrix) {
    all(matrix.rows(), matrix.cols());
    sink_(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(double));
  }
  void write(const RigidTransform& pose) { sink_(pose.data(), sizeof(double) * static_cast<std::size_t>(pose.matrix().size())); }
  template <class Entry>
  void write(const std::vector<Entry>& entries) {
    write(entries.size());
    for (const Entry& entry : entries) write(entry);
  }
  template <class Entry, std::size_t n>
  void write(const std::array<Entry, n>& entries) {
    for (const Entry& entry : entries) write(entry);
  }
  template <class Entry>
  void write(const std::optional<Entry>& entry) {
    write(entry.has_value());
    if (entry) write(*entry);
  }
  void write(const std::map<std::string, Vector3>& entries) {
    write(entries.size());
    for (const auto& [name, entry] : entries) all(name, entry);
  }

  void write(const PlannerMemory& m) {
    all(m.reason, m.calm_steps, m.feasible_steps, m.retry_from, m.retry_wait, m.retry_infeasible);
  }
  void write(const Activity& a) { all(a.phases, a.pin_of, a.asleep); }
  void write(const Unloading& u) { all(u.by_all, u.by_near, u.by_recoil, u.is_at_tear); }
  void write(const SpringState& s) { all(s.rest_lengths, s.broken, s.unloading); }
  void write(const Pin& p) { all(p.name, p.particles, p.origin, p.from); }
  void write(const TimedPose& p) { all(p.time, p.pose); }
  void write(const SteeredMotion& m) { all(m.number, m.poses); }
  void write(const Steering& s) { all(s.added_pins, s.pins, s.obstacles); }
  void write(const ContactNormal& n) { all(n.particle, n.normal); }
  void write(const PermittedCrossing& c) { all(c.obstacle, c.particle); }
  void write(const ContactMemory& c) { all(c.slip.displacement, c.slip.obstacle, c.pushed, c.normals, c.permitted_crossings); }
  void write(const MotionHistory& h) { all(h.in_frame, h.displacement, h.was_invisible, h.is_at_rest); }
  void write(const RestMemory& r) {
    all(r.window_begin, r.frames, r.x_at_frame, r.x_at_begins[0], r.x_at_begins[1], r.x_at_begins[2], r.x_beside_sleep);
    all(r.histories, r.sleepers);
  }
  void write(const EnergyMemory& e) { all(e.start, e.highest_gravity, e.stored, e.max_kinetic, e.fastest_drive, e.is_stale); }
  void write(const StretchHandover& h) { all(h.missed_steps, h.patience, h.solved_since); }
  void write(const PinGrip& g) { all(g.particle, g.from, g.time, g.position, g.triangle); }
  void write(const Link& l) {
    all(l.attachment, l.first, l.second, l.weights, l.triangle, l.anchor, l.distance, l.length, l.time, l.broken, l.impulse);
  }
  void write(const RecordedImpulses& i) { all(i.on_pinned, i.of_springs); }

  Sink sink_;
};

}  // namespace sprung
