#include "dynamics/attachments/attachments.h"

#include "base/problem_list.h"
#include "dynamics/attachments/engagement.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace sprung {
namespace {

void check_obstacles(const std::vector<Attachment>& attachments, std::size_t count) {
  ProblemList problems;
  for (std::size_t a = 0; a < attachments.size(); ++a) {
    const auto* end = std::get_if<ObstacleEnd>(&attachments[a].second);
    if (end == nullptr || (end->obstacle >= 0 && static_cast<std::size_t>(end->obstacle) < count)) continue;
    problems.add(entry_key("attachments", a) + ".second.obstacle", std::to_string(end->obstacle),
                 "must be the number of an obstacle; there are " + std::to_string(count), "count obstacles from 0");
  }
  problems.throw_if_any();
}

/// Whether an end sleeps. The simulator ensures that the other end then sleeps or is pinned.
bool joins_sleeping_particle(const SpringNetwork& network, const Link& link) {
  const auto sleeps = [&](Index particle) { return particle != kNone && network.is_asleep(particle); };
  return sleeps(link.first) || std::ranges::any_of(link.second, sleeps);
}

}  // namespace

Attachments::Attachments(const SpringNetwork& network, const ObstacleSet& obstacles, double step_length, bool implicit)
    : network_(network), obstacles_(obstacles), step_length_(step_length) {
  check_obstacles(network.attachments, obstacles.obstacles().size());
  rods_ = std::make_shared<Rods>(network, obstacles.obstacles());
  springs_ = std::make_shared<AttachmentSprings>(network, obstacles.obstacles(), step_length, implicit);
}

bool Attachments::update(SimulationState& state) {
  if (!update_links(network_, obstacles_, step_length_, state)) return false;
  load(state, steps_done(state) * step_length_);
  return true;
}

void Attachments::load(const SimulationState& state, double time) {
  rods_->load(state.links, time);
  springs_->load(state.links);
  springs_->set_time(time);
}

void Attachments::note_substep(double dt, double time, SimulationState& state) {
  if (state.substep == 0) {
    for (Link& link : state.links) {
      if (!joins_sleeping_particle(network_, link)) link.impulse.setZero();
    }
  }
  rods_->add_impulses(dt, state.links);
  springs_->add_impulses(dt, state.links);
  springs_->set_time(time);
}

bool Attachments::break_overloaded(SimulationState& state) {
  bool any = false;
  for (Link& link : state.links) {
    if (link.broken || !(force_of(link, state).norm() > network_.attachments[link.attachment].break_force)) continue;
    link.broken = state.step;
    any = true;
  }
  if (any) load(state, steps_done(state) * step_length_);
  return any;
}

Vector3 Attachments::force_of(const Link& link, const SimulationState& state) const {
  if (link.broken) return Vector3::Zero();
  if (network_.attachments[link.attachment].is_rigid()) return link.impulse / step_length_;
  return springs_->force_of(link, {.x = state.x, .v = state.v, .time = steps_done(state) * step_length_});
}

double Attachments::winch_speed(const SimulationState& state) const {
  constexpr double kSteepest = 1.5;  // slope of the smooth step from 0 to 1
  double fastest = 0.0;
  for (const Link& link : state.links) {
    if (link.broken || !network_.attachments[link.attachment].is_rigid()) continue;
    fastest = std::max(fastest, kSteepest / kWinchTime * std::abs(link.distance - link.length));
  }
  return fastest;
}

double end_of_changes(const Attachment& attachment, double step_length) {
  const double pulls = attachment.is_rigid() && attachment.rest_length ? kWinchTime : 0.0;
  const double begun = attachment.from > 0.0 || pulls > 0.0 ? attachment.from + step_length + pulls : 0.0;
  return std::isfinite(attachment.until) ? std::max(begun, attachment.until + step_length) : begun;
}

bool do_work(const std::vector<Attachment>& attachments) {
  return std::ranges::any_of(attachments, [](const Attachment& attachment) { return attachment.rest_length.has_value(); });
}

}  // namespace sprung
