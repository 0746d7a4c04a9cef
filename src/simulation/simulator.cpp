#include "simulation/simulator.h"

#include "dynamics/angle_force.h"
#include "dynamics/body_forces.h"
#include "dynamics/contact_projection.h"
#include "dynamics/penalty_contact.h"
#include "dynamics/spring_force.h"
#include "simulation/divergence.h"
#include "simulation/energy_watch.h"
#include "simulation/limit_handover.h"
#include "simulation/settings_check.h"
#include "simulation/start.h"
#include "simulation/step_check.h"
#include "simulation/step_refinement.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sprung {
namespace {

// Passes of contact when no stretch limit asks for more: enough for a particle in a corner between obstacles to settle.
constexpr int kContactPasses = 8;

// Passes end when none pushes a particle by more than this part of its gap.
constexpr double kContactTolerance = 1.0e-3;

// Corrections of stretch between the first pass and the last are so many times what is needed: of a hanging cloth's excess a third
// is left. But a spring on its own, which the first pass brings onto its limit, must not bounce there.
constexpr double kRelaxation = 1.8;

// Where surfaces stop particles short of where the passes led them, springs lead them and their neighbours on, at most so often,
// by so many passes each time, as many in all as the limit has: zones are made again before particles are far from where they were
// safe.
constexpr int kRelaxRounds = 16;
constexpr int kRelaxPasses = 2;

// Springs are looked at for one that gave way each step, large networks less often: about so many springs a step.
constexpr Index kSpringsCheckedPerStep = 8192;

// Energies, which cost more and take many steps to explode, less often still.
constexpr Index kStepsPerEnergy = 64;

}  // namespace

struct Simulator::Implementation {
  /// What contact alone did.
  struct PushOut {
    int passes = 0;
    bool any = false;  ///< whether anything was moved
  };

  Implementation(SpringNetwork model, SimulatorSettings chosen, std::vector<Obstacle> obstacles);

  template <class F, class... Arguments>
  F* add_force(Arguments&&... arguments) {
    auto force = std::make_unique<F>(network, std::forward<Arguments>(arguments)...);
    F* kept = force.get();
    forces.push_back(std::move(force));
    return kept;
  }

  [[nodiscard]] bool anything_moves() const;
  StepReport step();
  StepReport make_part();
  void choose_parts(double excess);
  void move_pins(double time);
  void constrain(StepReport& report);
  [[nodiscard]] PushOut push_out(int most_passes);
  void answer_contact();
  void settle(StepReport& report);
  [[nodiscard]] bool relax(Points& positions, double excess_before);
  [[nodiscard]] double elastic_energy() const;
  [[nodiscard]] Energies energies() const;
  void check_state();
  void check_energy(const Energies& now) const;
  void fail(StepFailure failure) const;
  [[nodiscard]] bool projects_contacts() const;
  [[nodiscard]] bool copies_positions() const { return contacts.meets_anything() || !integrator->keeps_positions(); }
  [[nodiscard]] const Points& step_began() const { return copies_positions() ? before : state.x_previous; }
  [[nodiscard]] StepMotion motion() const { return {before, v_before, advanced, dt()}; }
  [[nodiscard]] double dt() const { return std::ldexp(settings.step, -state.halvings); }
  [[nodiscard]] double time() const { return static_cast<double>(parts_done(state)) * dt(); }

  SpringNetwork network;
  SimulatorSettings settings;
  Environment environment;
  SpectralBounds bounds;
  std::vector<std::string> warnings;
  Forces forces;
  const Gravity* gravity = nullptr;
  const SpringForce* springs = nullptr;
  const AngleForce* angles = nullptr;  ///< when the network has angle bends
  PenaltyContact* penalty = nullptr;   ///< when contact answers by forces
  std::unique_ptr<Integrator> integrator;
  std::optional<StretchLimit> limit;
  std::optional<StepRefinement> refinement;  ///< when steps may be made in parts
  ContactProjection contacts;
  DivergenceCheck divergence;
  EnergyWatch energy_watch;
  SimulationState state;

  // Within a step: where it began, and where the forces alone would have ended it.
  Points before;    ///< for contact, and where the integrator does not keep them
  Points v_before;  ///< for contact alone
  Points advanced;  ///< for contact, and for integrators that need it
};

Simulator::Implementation::Implementation(SpringNetwork model, SimulatorSettings chosen, std::vector<Obstacle> obstacles)
    : network(std::move(model)),
      settings(std::move(chosen)),
      environment(std::move(obstacles)),
      bounds(simulation_bounds(network, settings, !environment.obstacles().empty())),
      warnings(check_step(settings, bounds)),
      integrator(make_integrator(settings.integrator, network)),
      contacts(network, environment),
      divergence(network),
      energy_watch(network, settings, environment.obstacles()),
      state(initial_state(network)) {
  check_settings(settings);
  const bool may_meet_anything = !environment.obstacles().empty() || bodies_may_meet(network);
  if (settings.stretch_limit) limit.emplace(network, *settings.stretch_limit, may_meet_anything);
  if (limit && settings.most_halvings > 0) refinement.emplace(*settings.stretch_limit, settings.most_halvings);
  const bool needs_parts = limit && (limit->may_follow_turn() || (limit->follows_turn() && anything_moves()));
  if (refinement && needs_parts) state.halvings = settings.most_halvings;
  gravity = add_force<Gravity>(settings.gravity);
  springs = add_force<SpringForce>();
  if (network.angle_bends.count() > 0) angles = add_force<AngleForce>();
  if (settings.air_drag > 0.0) add_force<AirDrag>(settings.air_drag, settings.wind);
  if (settings.contact.response == ContactSettings::Response::penalty && !environment.obstacles().empty()) {
    penalty = add_force<PenaltyContact>(environment, settings.contact.stiffness, settings.contact.damping, dt());
  }
  environment.set_interval(0.0, 0.0);
  move_pins(0.0);
  Start start = find_start(network, environment, settings.contact, state.x);
  state.x = std::move(start.positions);
  for (const auto& more : {start.warnings, idle_settings(settings, network)}) {
    warnings.insert(warnings.end(), more.begin(), more.end());
  }
  integrator->start(state, forces, dt());
  energy_watch.note(0, energies());
}

/// Whether something does at the start: by how much it will turn is not known yet.
bool Simulator::Implementation::anything_moves() const {
  return !network.velocities.isZero(0.0) || std::ranges::any_of(network.pins, [](const Pin& pin) { return pin.motion.moves(); });
}

StepReport Simulator::Implementation::step() {
  const int parts = 1 << state.halvings;
  StepReport report;
  for (int part = 0; part < parts; ++part) report += make_part();
  if (refinement) choose_parts(report.stretch_excess);
  if (limit) hand_over_missed(network, *limit, report.stretch_excess, state);
  return report;
}

StepReport Simulator::Implementation::make_part() {
  const double t = time();
  const double t_end = static_cast<double>(parts_done(state) + 1) * dt();
  if (copies_positions()) before = state.x;
  if (contacts.meets_anything()) v_before = state.v;

  integrator->advance(state, forces, dt());
  environment.set_interval(t, t_end);
  move_pins(t_end);
  if (contacts.meets_anything() || (limit && integrator->needs_advanced())) advanced = state.x;

  StepReport report{.parts = 1};
  constrain(report);
  settle(report);
  if (++state.part == 1 << state.halvings) {
    ++state.step;
    state.part = 0;
  }
  if (penalty != nullptr) environment.set_interval(t_end, t_end);
  check_state();
  return report;
}

void Simulator::Implementation::choose_parts(double excess) {
  const double dt_before = dt();
  if (limit->follows_turn(state.stretch_holds)) {
    refinement->choose_by_turn(limit->turn(), state);
  } else if (!limit->may_follow_turn()) {
    refinement->choose(excess, state);
  }
  if (dt() == dt_before) return;
  if (penalty != nullptr) penalty->set_step(dt());
  move_pins(time());
  integrator->step_changed(state, forces, dt_before, dt());
}

// A pin's velocity is that of the step to come: what its neighbours' dampers see.
void Simulator::Implementation::move_pins(double time) {
  for (const Pin& pin : network.pins) {
    if (!pin.motion.moves()) continue;
    const RigidTransform origin(Eigen::Translation3d(pin.origin));
    const RigidTransform now = pin.motion.pose(origin, time) * origin.inverse();
    const RigidTransform next = pin.motion.pose(origin, time + dt()) * origin.inverse();
    for (const Index i : pin.particles) {
      const Vector3 start = network.positions.col(i);
      state.x.col(i) = now * start;
      state.v.col(i) = (next * start - state.x.col(i)) / dt();
      energy_watch.note_drive(state.v.col(i).norm());
    }
  }
}

// Where contact and springs want particles elsewhere, what speaks last is held, and the other is off by what a pass moves. That is
// the gap, of which truncation leaves half: contact in the end would draw what hangs over a tip longer by as much, with few passes
// by a fifth of its length and more.
void Simulator::Implementation::constrain(StepReport& report) {
  const bool projects = projects_contacts();
  if (!projects && !limit) return;
  if (projects) contacts.find(motion());
  if (projects && integrator->answers_contact()) answer_contact();
  const double fall = (settings.gravity.norm() + bounds.drag * settings.wind.norm()) * dt() * dt();
  const std::optional<int> solves = limit ? limit->solve(step_began(), state.x, fall, state.stretch_holds) : std::nullopt;
  report.limit_solves = solves.value_or(0);
  const int limit_passes = limit ? limit->settings().iterations + (solves ? 1 : 0) : 0;  // after a solve the first only measures
  if (projects) report.iterations = push_out(kContactPasses - limit_passes).passes;
  bool settled = false;
  for (int pass = 0; pass < limit_passes && !settled; ++pass) {
    const bool between = pass > 0 && pass + 1 < limit_passes;
    const double push = projects ? contacts.project(state.x) : 0.0;
    const double excess = solves && pass == 0 ? limit->excess(state.x) : limit->project(state.x, between ? kRelaxation : 1.0);
    settled = excess <= limit->settings().tolerance && push <= kContactTolerance;
    ++report.iterations;
  }
}

Simulator::Implementation::PushOut Simulator::Implementation::push_out(int most_passes) {
  PushOut done;
  while (done.passes < most_passes) {
    const double push = contacts.project(state.x);
    ++done.passes;
    done.any = done.any || push > 0.0;
    if (push <= kContactTolerance) break;
  }
  return done;
}

void Simulator::Implementation::answer_contact() {
  if (push_out(kContactPasses).any) integrator->answer_contact(advanced, state.x, dt());
}

void Simulator::Implementation::settle(StepReport& report) {
  if (!contacts.meets_anything() && !limit) return;
  report.stretch_excess = limit ? limit->excess(state.x) : 0.0;
  const int most_rounds = limit ? std::min(kRelaxRounds, limit->settings().iterations / kRelaxPasses) : 0;
  int rounds = 0;
  const auto relax_again = [&](Points& positions) { return rounds++ < most_rounds && relax(positions, report.stretch_excess); };
  if (contacts.meets_anything()) contacts.truncate(before, state.x, relax_again);
  integrator->recover_velocities(state, step_began(), advanced, dt());
  if (contacts.meets_anything()) contacts.settle_velocities(motion(), state, *integrator);
  report.truncated = contacts.truncated_count();
  report.squeezed = contacts.squeezed_count();
  if (limit && (rounds > 0 || report.truncated > 0)) report.stretch_excess = limit->excess(state.x);
}

// What truncation stopped met something that no contact told of: those are found where it is now. What springs were too long before
// is none of truncation's doing, unless it is more than they may be longer altogether: then passes are wanted in any case.
bool Simulator::Implementation::relax(Points& positions, double excess_before) {
  const StretchLimitSettings& limits = limit->settings();
  if (limit->excess(positions) <= std::max(limits.tolerance, std::min(excess_before, limits.max_stretch))) return false;
  if (projects_contacts()) contacts.find_again(motion(), positions);
  for (int pass = 0; pass < kRelaxPasses; ++pass) {
    if (projects_contacts()) contacts.project(positions);
    limit->project(positions);
  }
  return true;
}

void Simulator::Implementation::check_state() {
  if (const auto failure = divergence.not_finite(state, step_began())) fail(*failure);
  const Index check_interval = 1 + network.springs.count() / kSpringsCheckedPerStep;
  if (state.step % check_interval == 0) {
    if (const auto failure = divergence.overstretched(state.x)) fail(*failure);
  }
  if (state.step > 1 && state.step % (kStepsPerEnergy * check_interval) != 0) return;
  if (!energy_watch.watches()) return;
  const Energies now = energies();
  energy_watch.note(state.step, now);
  check_energy(now);
}

void Simulator::Implementation::check_energy(const Energies& now) const {
  const auto explosion = energy_watch.explosion(now);
  if (!explosion) return;
  StepFailure failure = divergence.fastest(state);
  failure.cause = *explosion + (failure.cause.empty() ? "" : "; " + failure.cause);
  fail(std::move(failure));
}

double Simulator::Implementation::elastic_energy() const {
  return springs->energy(state.x) + (angles != nullptr ? angles->energy(state.x) : 0.0);
}

Energies Simulator::Implementation::energies() const {
  return {.kinetic = 0.5 * network.masses.dot(state.v.colwise().squaredNorm().transpose()),
          .elastic = elastic_energy(),
          .gravity = gravity->energy(state.x)};
}

void Simulator::Implementation::fail(StepFailure failure) const {
  failure.step = state.step;
  failure.time = time();
  failure.remedy = divergence_remedy(settings, bounds);
  throw StepError(std::move(failure));
}

bool Simulator::Implementation::projects_contacts() const {
  return settings.contact.response == ContactSettings::Response::projection && contacts.meets_anything();
}

StepReport& StepReport::operator+=(const StepReport& part) {
  parts += part.parts;
  iterations += part.iterations;
  limit_solves += part.limit_solves;
  stretch_excess = std::max(stretch_excess, part.stretch_excess);
  truncated += part.truncated;
  squeezed += part.squeezed;
  return *this;
}

Simulator::Simulator(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles)
    : implementation_(std::make_unique<Implementation>(std::move(network), std::move(settings), std::move(obstacles))) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

StepReport Simulator::step() { return implementation_->step(); }
const SpringNetwork& Simulator::network() const { return implementation_->network; }
const SimulatorSettings& Simulator::settings() const { return implementation_->settings; }
const SimulationState& Simulator::state() const { return implementation_->state; }
const Environment& Simulator::environment() const { return implementation_->environment; }
const std::vector<std::string>& Simulator::warnings() const { return implementation_->warnings; }
double Simulator::time() const { return implementation_->time(); }
double Simulator::gravity_energy() const { return implementation_->gravity->energy(state().x); }
double Simulator::elastic_energy() const { return implementation_->elastic_energy(); }

std::string Simulator::stretch_solver() const {
  return implementation_->limit ? implementation_->limit->chosen_solver() : std::string();
}

Index Simulator::contact_count() const {
  return implementation_->penalty != nullptr ? implementation_->penalty->contact_count(state().x)
                                             : implementation_->contacts.contact_count();
}

void Simulator::check() const {
  if (const auto failure = implementation_->divergence.overstretched(state().x)) implementation_->fail(*failure);
  implementation_->check_energy(implementation_->energies());
}

}  // namespace sprung
