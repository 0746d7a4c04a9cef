#include "simulation/step/step_constraints.h"

#include "dynamics/integrators/schemes.h"
#include "simulation/step/step_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sprung {
namespace {

// Over-relaxation of the stretch limit between the first pass and the last. It leaves a third of a hanging cloth's excess. A single
// spring reaches its limit in the first pass and must not oscillate about it, so the first and last pass are not over-relaxed.
constexpr double kRelaxation = 1.8;

// While only the limit asks for another pass, the relaxation of that pass grows from 0 at the tolerance by one half for each
// further tolerance of excess. A hanging cloth may come to rest near the tolerance. If one more pass acted with its whole strength
// there, and over-relaxation threw springs beyond their limit, the cloth would be pulled up with speed in some steps and sink in
// others, for ever.
constexpr double kRelaxationGrowth = 0.5;

double fading_relaxation(double tolerance, double excess) {
  const bool is_far = excess * kRelaxationGrowth >= (kRelaxation + kRelaxationGrowth) * tolerance;
  return is_far ? kRelaxation : kRelaxationGrowth * (excess / tolerance - 1.0);
}

// Minimum number of passes if there are constraints: a rate [1/s] and a number per substep. Errors that remain are small in small
// steps, and the next step corrects them.
constexpr double kConstraintPassRate = 1200.0;
constexpr double kMinConstraintPasses = 4.0;

// While a constraint is violated by more than this multiple of its tolerance after the last pass, as by an impact, it gets up to so
// many times the passes. Before the last pass it is violated by the over-relaxation of the limit.
constexpr double kGrossViolation = 10.0;
constexpr int kPassesOfGrossViolation = 4;

// Calls of Integrator::respond_to_contact a step after contact passes, at most. Friction settles in 2 to 20 of them: with 6, a
// rope does not slide on a drum whose friction is 5 % too small.
constexpr int kResponses = 24;

// After as many of these, the next ones only settle friction, and end when the contacts change. A cloth that strikes an obstacle
// leaves it in more and more particles from one call to the next: after 24 of them it is stretched by a third.
constexpr int kContactResponses = 6;

// Calls after truncation, at most.
constexpr int kTruncationResponses = 6;

// Where truncation stops particles short of their projected positions, the stretch limit moves them and their neighbours again: at
// most so many rounds of so many passes, and in total no more passes than the limit's iterations. Few passes a round let the safe
// regions be rebuilt before particles move far from where they were safe.
constexpr int kRelaxRounds = 16;
constexpr int kRelaxPasses = 2;

// Calls of the limit's solver and passes that correct_positions() makes at most. Excess that remains is corrected by the steps.
constexpr int kCorrections = 16;

// The excess at which correct_positions() ends. The next step would remove more of it at once, with speed.
constexpr double kCorrected = 1.0e-6;

/// The largest relative motion of a spring's ends, in rest lengths.
double largest_strain(const Springs& springs, const Points& displacement) {
  double largest = 0.0;
  for (Index s = 0; s < springs.count(); ++s) {
    const double length = springs.rest_length[s];
    if (length > 0.0) {
      const Vector3 apart = displacement.col(springs.first[s]) - displacement.col(springs.second[s]);
      largest = std::max(largest, apart.squaredNorm() / (length * length));
    }
  }
  return std::sqrt(largest);
}

}  // namespace

StepConstraints::StepConstraints(const SpringNetwork& network, const SimulatorSettings& settings, ContactProjection& contacts,
                                 Integrator& integrator, bool has_obstacles)
    : network_(network), settings_(settings), integrator_(integrator), contacts_(contacts) {
  if (!settings.stretch_limit) return;
  limit_.emplace(network, *settings.stretch_limit, limit_use(network, settings, has_obstacles));
}

void StepConstraints::begin(const SimulationState& state) {
  inner_number_ = state.substep % inner_;
  if (copies_positions()) before_ = state.x;
  if (!contacts_.can_collide()) return;
  v_before_ = state.v;
  slip_before_ = state.contact.slip;
  if (inner_ > 1 && inner_number_ == 0) first_before_ = before_;
}

void StepConstraints::apply(const ObstacleFrame& frame, const ObstacleFrame& part, SimulationState& state, const Forces& forces,
                            double dt, StepReport& report) {
  if (!contacts_.can_collide() && !limit_ && constraints_.empty()) return;
  for (const auto& constraint : constraints_) constraint->prepare(part.end());
  if (contacts_.can_collide() || integrator_.needs_advanced()) advanced_ = state.x;
  dt_ = dt;
  recorder_ = ImpulseRecorder(state.impulses, dt);
  if (projects_contacts()) find_contacts(frame, part);
  project(state, forces, report);
  report.stretch_excess = limit_ ? limit_->excess(state.x) : 0.0;
  end_substep(frame, state, forces, report);
  recorder_ = {};
}

/// In the first inner substep, finds contacts on the path that forces give particles in the whole contact step: that of a flight.
void StepConstraints::find_contacts(const ObstacleFrame& frame, const ObstacleFrame& part) {
  if (inner_number_ == 0) {
    if (inner_ > 1) {
      predicted_ = before_ + inner_ * (advanced_ - before_);
      const Vector3 later = 0.5 * inner_ * (inner_ - 1) * dt_ * dt_ * settings_.gravity;
      for_free_particles(network_, [&](Index i) { predicted_.col(i) += later; });
    }
    contacts_.detect(frame, contact_step());
  }
  contacts_.begin_part(frame, part, motion(), static_cast<double>(inner_number_ + 1) / inner_, 1.0 / inner_);
}

void StepConstraints::correct_positions(const ObstacleFrame& frame, SimulationState& state, double dt) {
  dt_ = dt;
  recorder_ = {};  // velocities stay as they are
  const auto excess = [&](const Points& x) { return limit_ ? limit_->excess(x) : 0.0; };
  for (int k = 0; k < kCorrections && (excess(state.x) > kCorrected || violation(state.x) > 1.0); ++k) {
    begin(state);
    slip_before_.displacement.setZero();  // this is no step: friction takes nothing back
    const Points start = state.x;
    advanced_ = start;
    if (projects_contacts()) contacts_.find(frame, motion());
    StepReport report;
    make_passes(state, report);
    const int passes = std::max(limit_ ? limit_->settings().iterations : 0, constraint_passes());
    repeat_until_settled(passes, [&](int /*pass*/) {
      if (projects_contacts()) contacts_.project(state.x);
      const double violation_before = sprung::project(constraints_, start, state.x, recorder_);
      const double excess_before = limit_ ? limit_->project(start, state.x) : 0.0;
      return excess_before <= kCorrected && violation_before <= 1.0;
    });
    int rounds = 0;
    const double excess_left = excess(state.x);
    const double violation_left = violation(state.x);
    const StepTruncation::Relax relax_again = [&](Points& positions) {
      return rounds++ < max_relax_rounds() && relax(frame, positions, excess_left, violation_left);
    };
    if (contacts_.can_collide()) contacts_.truncate(frame, motion(), state.x, relax_again);
    state.x_previous += state.x - start;
  }
}

void StepConstraints::project(SimulationState& state, const Forces& forces, StepReport& report) {
  if (projects_contacts() && integrator_.responds_to_contact()) respond_to_contact(state, forces);
  make_passes(state, report);
}

std::optional<int> StepConstraints::solve_limit(SimulationState& state) {
  const double steady_displacement = steady_acceleration_ * dt_ * dt_;
  if (!rods_) return limit_->solve(positions_before(state), state.x, steady_displacement, state.limit.handovers, recorder_);
  std::vector<Vector3> pushes(rods_->rows().size(), Vector3::Zero());
  const std::optional<int> solves =
      limit_->solve(positions_before(state), state.x, steady_displacement, state.limit.handovers, rods_->rows(), pushes, recorder_);
  rods_->add_pushes(pushes);
  return solves;
}

// Contact comes before the limit in each pass. Where they disagree, the last one is satisfied and the other is violated by the
// motion of one pass. The limit's motion is within the gap, of which truncation leaves half. In the reverse order, a cloth that
// hangs over a tip would stretch by the same amount, which in few passes is a fifth of its length and more.
void StepConstraints::make_passes(SimulationState& state, StepReport& report) {
  const bool projects = projects_contacts();
  const std::optional<int> solves = limit_ && global_limit_ ? solve_limit(state) : std::nullopt;
  if (limit_ && global_limit_) report.deformation = limit_->deformation();
  report.limit_solves = solves.value_or(0);
  const int limit_passes = limit_ ? passes_of_limit() + (solves ? 1 : 0) : 0;  // the first after a solve only measures
  const int passes = std::max(limit_passes, constraint_passes());
  if (projects) report.iterations = contacts_.push_out(state.x, kContactPasses - passes).passes;
  const int max_passes = constraints_.empty() ? passes : kPassesOfGrossViolation * passes;
  double relaxation = 1.0;  // of the limit in the next pass
  report.iterations += repeat_until_settled(max_passes, [&](int pass) {
    const bool is_last = pass + 1 >= passes;
    const double push = projects ? contacts_.project(state.x) : 0.0;
    const double violation = sprung::project(constraints_, positions_before(state), state.x, recorder_);
    double excess = 0.0;
    if (limit_) {
      excess = solves && pass == 0
                   ? limit_->excess(state.x)
                   : limit_->project(positions_before(state), state.x, is_last ? std::min(relaxation, 1.0) : relaxation, recorder_);
    }
    if (is_last && (violation <= kGrossViolation || this->violation(state.x) <= kGrossViolation)) return true;
    const bool others_settled = violation <= 1.0 && push <= kContactTolerance;
    if (others_settled && (!limit_ || excess <= limit_->settings().tolerance)) return true;
    relaxation = others_settled ? fading_relaxation(limit_->settings().tolerance, excess) : kRelaxation;
    return false;
  });
}

// The response of the integrator moves further particles, so contact pushes again.
void StepConstraints::respond_to_contact(SimulationState& state, const Forces& forces) {
  responded_ = advanced_;
  constrained_.clear(static_cast<Index>(state.x.cols()));
  double settled = 0.0;
  bool again = false;
  for (int round = 0; round < kResponses; ++round) {
    if (!(contacts_.push_out(state.x).largest > settled) && !again) break;
    settled = kContactTolerance;
    const std::size_t contacts_before = constrained_.contact_count();
    constrained_.clear(static_cast<Index>(state.x.cols()));
    contacts_.constrain_pushed(motion(), constrained_);
    if (round >= kContactResponses && constrained_.contact_count() != contacts_before) break;
    again = integrator_.respond_to_contact(motion(), forces, responded_, constrained_, state);
    responded_ = state.x;
  }
  if (!state.impulses.has_contact()) return;
  Points pushes = Points::Zero(3, state.x.cols());
  contacts_.add_pushes(motion(), pushes);
  integrator_.record_contact(motion(), pushes, state);
}

void StepConstraints::end_substep(const ObstacleFrame& frame, SimulationState& state, const Forces& forces, StepReport& report) {
  if (is_last()) {
    end_contact_step(frame, state, forces, report);
  } else {
    integrator_.recover_velocities(state, forces, positions_before(state), advanced_, dt_);
  }
  if (!contacts_.can_collide()) return;
  contacts_.settle_velocities(motion(), state, integrator_);
  if (recorder_.on() && projects_contacts()) contacts_.record(motion(), recorder_);
  if (state.impulses.has_contact() && projects_contacts()) {
    contacts_.add_pushes(motion(), state.impulses.of_contact);
    contacts_.add_settled(state.impulses.of_contact);
  }
  contacts_.note_slip(motion(), state);
}

/// Truncates the path of the whole contact step and recovers velocities.
void StepConstraints::end_contact_step(const ObstacleFrame& frame, SimulationState& state, const Forces& forces,
                                       StepReport& report) {
  const bool can_collide = contacts_.can_collide();
  const bool responds = !limit_ && constraints_.empty() && integrator_.responds_to_contact() && projects_contacts();
  const int max_rounds = responds ? kTruncationResponses : max_relax_rounds();
  const double violation_before = can_collide ? violation(state.x) : 0.0;
  int rounds = 0;
  const StepTruncation::Relax relax_again = [&](Points& positions) {
    if (rounds++ >= max_rounds) return false;
    return responds ? respond_to_truncation(state, forces) : relax(frame, positions, report.stretch_excess, violation_before);
  };
  if (responds) responded_ = state.x;
  if (inner_ == 1) {
    if (can_collide) contacts_.truncate(frame, motion(), state.x, relax_again);
    integrator_.recover_velocities(state, forces, positions_before(state), advanced_, dt_);
  } else {
    Points truncated = state.x;
    if (can_collide) contacts_.truncate(frame, contact_step(), motion(), truncated, relax_again);
    integrator_.recover_velocities(state, forces, positions_before(state), advanced_, dt_);
    if (contacts_.truncated_count() > 0) report.truncation_strain = largest_strain(network_.springs, truncated - state.x);
    add_displacement(truncated, state);
  }
  if (can_collide) contacts_.limit_speed_of_moved(motion(), state, integrator_);
  report.truncated = contacts_.truncated_count();
  report.infeasible = contacts_.infeasible_count();
  if (limit_ && (rounds > 0 || report.truncated > 0)) report.stretch_excess = limit_->excess(state.x);
}

/// A displacement that took the whole contact step: a velocity by the last inner substep would throw particles backwards.
void StepConstraints::add_displacement(const Points& displaced, SimulationState& state) const {
  for_free_particles(network_, [&](Index i) {
    if (displaced.col(i) == state.x.col(i)) return;
    state.v.col(i) += (displaced.col(i) - state.x.col(i)) / (inner_ * dt_);
    state.x.col(i) = displaced.col(i);
    integrator_.velocity_changed(state, i, dt_);
  });
}

int StepConstraints::passes_of_limit() const { return passes_of(limit_->settings(), inner_ > 1); }

int StepConstraints::max_relax_rounds() const {
  const int passes = std::max(limit_ ? limit_->settings().iterations : 0, constraint_passes());
  return std::min(kRelaxRounds, passes / kRelaxPasses);
}

int StepConstraints::constraint_passes() const {
  return constraints_.empty() ? 0 : static_cast<int>(std::max(kMinConstraintPasses, std::round(kConstraintPassRate * dt_)));
}

// Truncation stopped particles at surfaces for which no contact was found; find_again() finds these. Excess from before truncation
// is not relaxed here, unless it exceeds max_stretch: then further passes are needed in any case. With constraints they are not:
// springs and cells hold each other, and the excess that passes leave is the same in each step.
bool StepConstraints::relax(const ObstacleFrame& frame, Points& positions, double excess_before, double violation_before) {
  const auto permitted = [&](const StretchLimitSettings& settings) {
    return std::max(settings.tolerance, constraints_.empty() ? std::min(excess_before, settings.max_stretch) : excess_before);
  };
  const bool stretched = limit_ && limit_->excess(positions) > permitted(limit_->settings());
  if (!stretched && violation(positions) <= std::max(1.0, violation_before)) return false;
  if (projects_contacts()) contacts_.find_again(frame, contact_step(), motion(), 1.0 / inner_, positions);
  for (int pass = 0; pass < kRelaxPasses; ++pass) {
    if (projects_contacts()) contacts_.project(positions);
    sprung::project(constraints_, before_, positions, recorder_);
    if (limit_) limit_->project(before_, positions, 1.0, recorder_);
  }
  return true;
}

// The displacement by truncation constrains a particle as a push does. The integrator writes to the state, which truncation reads.
bool StepConstraints::respond_to_truncation(SimulationState& state, const Forces& forces) {
  if (state.x == responded_) return false;
  for (Index i = 0; i < static_cast<Index>(state.x.cols()); ++i) {
    const Vector3 stopped = state.x.col(i) - responded_.col(i);
    if (!stopped.isZero(0.0)) constrained_.add(i, stopped);
  }
  integrator_.respond_to_contact(motion(), forces, responded_, constrained_, state);
  responded_ = state.x;
  return true;
}

bool StepConstraints::projects_contacts() const {
  return settings_.contact.response == ContactSettings::Response::projection && contacts_.can_collide();
}

}  // namespace sprung
