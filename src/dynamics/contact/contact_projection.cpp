#include "dynamics/contact/contact_projection.h"

#include "dynamics/contact/collision_surface_builder.h"
#include "dynamics/contact/contact_materials.h"
#include "dynamics/state/simulation_state.h"

#include <algorithm>
#include <utility>

namespace sprung {
namespace {

// Search margin beyond the gap, as a fraction of the thickness: the passes of a step move resting particles less.
constexpr double kMargin = 0.5;

// Rounds of contact between bodies that truncation found. For a cube of 1 kg that hits a cloth of 0.2 kg at 3 m/s, twice the rounds
// or twelve times the passes conserve no more of its momentum.
constexpr int kBodyRounds = 4;

/// For the motion during the passes of a step [m].
double margin_of(const SpringNetwork& network, const std::vector<Obstacle>& obstacles) {
  double largest = 0.0;
  for (const Obstacle& obstacle : obstacles) largest = std::max(largest, obstacle.material.thickness);
  return kMargin * (particle_thickness(network).maxCoeff() + largest);
}

}  // namespace

ContactProjection::ContactProjection(const SpringNetwork& network, const ObstacleSet& obstacles)
    : solver_(network, obstacles),
      truncation_(obstacles, contact_surface(network), network.positions, margin_of(network, obstacles.obstacles())) {}

void ContactProjection::detect(const ObstacleFrame& frame, const StepMotion& motion) {
  truncation_.begin_step(frame, motion.before, motion.advanced);
  contacts_ = &truncation_.contacts(frame, motion.before, motion.advanced);
}

// Contacts are those at the end of the step. Within it, their planes move with their obstacles.
void ContactProjection::begin_part(const ObstacleFrame& frame, const ObstacleFrame& part, const StepMotion& motion, double ended,
                                   double share) {
  if (share == 1.0 || !frame.set().moves()) return solver_.start(part, *contacts_, motion);
  std::vector<Contact> moved = *contacts_;
  for (Contact& contact : moved) {
    if (contact.obstacle == kNone) continue;
    const RigidTransform back = part.after(contact.obstacle) * frame.into_after(contact.obstacle);
    contact.point = back * Vector3(contact.point - (1.0 - ended) * contact.drift);
    contact.normal = back.linear() * contact.normal;
    contact.drift *= share;
  }
  solver_.start(part, moved, motion);
}

void ContactProjection::find_again(const ObstacleFrame& frame, const StepMotion& motion, const StepMotion& part, double share,
                                   const Points& positions) {
  FreshContacts fresh = truncation_.renewed_contacts(frame, motion.before, positions);
  for (Contact& contact : fresh.contacts) contact.drift *= share;
  solver_.renew(fresh, part);
}

ContactProjection::PushOut ContactProjection::push_out(Points& positions, int max_passes) {
  PushOut done;
  done.passes = repeat_until_settled(max_passes, [&](int) {
    const double push = project(positions);
    done.largest = std::max(done.largest, push);
    return push <= kContactTolerance;
  });
  return done;
}

void ContactProjection::truncate(const ObstacleFrame& frame, const StepMotion& motion, const StepMotion& part, Points& positions,
                                 const StepTruncation::Relax& relax) {
  added_.clear();
  TruncationResult result = truncation_.bodies_can_collide() ? truncate_bodies(frame, motion, part, positions, relax)
                                                             : truncation_.truncate(frame, motion.before, positions, relax);
  moved_with_obstacles_ = std::move(result.moved_with_obstacles);
  truncated_ = result.truncated;
  infeasible_ = result.infeasible;
}

void ContactProjection::limit_speed_of_moved(const StepMotion& motion, SimulationState& state, const Integrator& integrator) const {
  for (const Index i : moved_with_obstacles_) {
    const double max_speed = (motion.advanced.col(i) - motion.before.col(i)).norm() / motion.dt;
    const double speed = state.v.col(i).norm();
    if (!(speed > max_speed)) continue;
    state.v.col(i) *= max_speed / speed;
    integrator.velocity_changed(state, i, motion.dt);
  }
}

// Truncation stops each of two bodies without regard to their masses: a cube that hits a light cloth would stop in mid-air, and a
// cube that rests on it would be thrown up. The contacts that truncation found are therefore solved before it is repeated. `relax`
// keeps state of its own, so it is called only once the bodies are apart.
TruncationResult ContactProjection::truncate_bodies(const ObstacleFrame& frame, const StepMotion& motion, const StepMotion& part,
                                                    Points& positions, const StepTruncation::Relax& relax) {
  Points solved = positions;
  TruncationResult result = truncation_.truncate(frame, motion.before, positions);
  for (int round = 0; round < kBodyRounds && add_body_contacts(result.body_contacts, part); ++round) {
    if (!push_out(solved).moved()) break;
    positions = solved;
    result = truncation_.truncate(frame, motion.before, positions);
  }
  if (!relax || result.truncated == 0 || result.infeasible > 0 || result.subdivided) return result;
  positions = solved;
  return truncation_.truncate(frame, motion.before, positions, relax);
}

/// Adds the contacts that are new in this step to the solver. Returns whether there are any.
bool ContactProjection::add_body_contacts(const std::vector<Contact>& contacts, const StepMotion& motion) {
  std::vector<Contact> fresh;
  for (const Contact& contact : contacts) {
    if (!added_.contains(contact.particles)) fresh.push_back(contact);
  }
  for (const Contact& contact : fresh) added_.insert(contact.particles);
  solver_.add(fresh, motion);
  return !fresh.empty();
}

}  // namespace sprung
