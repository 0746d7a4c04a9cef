#include "dynamics/contact/contact_projection.h"

#include "dynamics/contact/collision_surface_builder.h"
#include "dynamics/contact/contact_materials.h"

#include <algorithm>
#include <utility>

namespace sprung {
namespace {

// Contacts are looked for this part of the thickness beyond the gap at most: the passes of a step move resting particles less.
constexpr double kMargin = 0.5;

// Bodies that stop each other are led apart so often, by so many passes each time. Of a cube of 1 kg that meets a cloth of 0.2 kg
// at 3 m/s twice the rounds, or twelve times the passes, kept no more of its momentum.
constexpr int kMeetingRounds = 4;
constexpr int kMeetingPasses = 8;

// Passes end when none pushes a particle by more than this part of its gap.
constexpr double kContactTolerance = 1.0e-3;

/// For what the passes of a step may move [m].
double margin_of(const SpringNetwork& network, const std::vector<Obstacle>& obstacles) {
  double largest = 0.0;
  for (const Obstacle& obstacle : obstacles) largest = std::max(largest, obstacle.material.thickness);
  return kMargin * (particle_thickness(network).maxCoeff() + largest);
}

}  // namespace

ContactProjection::ContactProjection(const SpringNetwork& network, Environment& environment)
    : response_(network, environment),
      free_space_(environment, contact_surface(network), network.positions, margin_of(network, environment.obstacles())) {}

void ContactProjection::find(const StepMotion& motion) {
  free_space_.begin_step(motion.before, motion.advanced);
  response_.start(free_space_.contacts(motion.before, motion.advanced), motion);
}

void ContactProjection::find_again(const StepMotion& motion, const Points& positions) {
  response_.renew(free_space_.renewed_contacts(motion.before, positions), motion);
}

void ContactProjection::truncate(const StepMotion& motion, Points& positions, const StepTruncation::Relax& relax) {
  noted_.clear();
  const bool meet = free_space_.bodies_can_collide();
  TruncationResult truncation =
      meet ? truncate_bodies(motion, positions, relax) : free_space_.truncate(motion.before, positions, relax);
  taken_along_ = std::move(truncation.moved_with_obstacles);
  truncated_ = truncation.truncated;
  infeasible_ = truncation.infeasible;
}

void ContactProjection::slow_down_taken_along(const StepMotion& motion, SimulationState& state,
                                              const Integrator& integrator) const {
  for (const Index i : taken_along_) {
    const double most = (motion.advanced.col(i) - motion.before.col(i)).norm() / motion.dt;
    const double speed = state.v.col(i).norm();
    if (!(speed > most)) continue;
    state.v.col(i) *= most / speed;
    integrator.velocity_changed(state, i, motion.dt);
  }
}

// Truncation stops each of two bodies for itself, whatever the other weighs: a cube that flew into a light cloth stopped in
// mid-air, and one that lay on it was thrown up again. What contact led them into is told to it, and it tries again. What leads on
// where obstacles stop something notes what it did, and so is asked once, when bodies are out of each other's way.
TruncationResult ContactProjection::truncate_bodies(const StepMotion& motion, Points& positions,
                                                    const StepTruncation::Relax& relax) {
  Points led = positions;
  TruncationResult truncation = free_space_.truncate(motion.before, positions);
  for (int round = 0; round < kMeetingRounds && note_meetings(truncation.body_contacts, motion); ++round) {
    if (!answer_meetings(led)) break;
    positions = led;
    truncation = free_space_.truncate(motion.before, positions);
  }
  if (!relax || truncation.truncated == 0 || truncation.infeasible > 0 || truncation.subdivided) return truncation;
  positions = led;
  return free_space_.truncate(motion.before, positions, relax);
}

/// Whether any is new.
bool ContactProjection::note_meetings(const std::vector<Contact>& meetings, const StepMotion& motion) {
  std::vector<Contact> fresh;
  for (const Contact& meeting : meetings) {
    if (!noted_.contains(meeting.particles)) fresh.push_back(meeting);
  }
  for (const Contact& meeting : fresh) noted_.insert(meeting.particles);
  response_.add(fresh, motion);
  return !fresh.empty();
}

/// Whether any moved.
bool ContactProjection::answer_meetings(Points& positions) {
  bool any = false;
  for (int pass = 0; pass < kMeetingPasses; ++pass) {
    const double push = response_.project(positions);
    any = any || push > 0.0;
    if (push <= kContactTolerance) break;
  }
  return any;
}

}  // namespace sprung
