#include "simulation/simulator.h"

#include "base/format.h"
#include "base/problem_list.h"
#include "simulation/change_check.h"
#include "simulation/checkpoint.h"
#include "simulation/reaction_record.h"
#include "simulation/settings/settings_check.h"
#include "simulation/start/moved_check.h"
#include "simulation/step/step_check.h"
#include "simulation/stepper.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sprung {
namespace {

void check_number_of(const std::string& key, const std::string& what, std::size_t number, std::size_t count) {
  check_entry(key, what, static_cast<std::int64_t>(number), static_cast<std::int64_t>(count));
}

bool bounds_step(const Force& force) {
  std::vector<LinearElement> elements;
  force.append_elements(elements);
  return !elements.empty();
}
bool bounds_step(const Constraint& /*constraint*/) { return false; }

}  // namespace

struct Simulator::Implementation {
  Implementation(std::shared_ptr<const Model> shared, Control chosen, const SimulationState& from)
      : model(std::move(shared)), control(std::move(chosen)), state(from) {
    scratch = std::make_unique<Scratch>(*model, control, state);
    stepper().initialize();
  }
  /// At the start.
  Implementation(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles, const StartState& start)
      : model(Model::build(std::move(network), std::move(settings), std::move(obstacles), start, scratch)),
        state(model->initial_state()) {}

  Stepper stepper() { return {*model, control, state, *scratch}; }
  [[nodiscard]] const SpringNetwork& network() const { return scratch->network; }

  void wake();
  template <class Change>
  void change_awake(const Change& change);
  void change_activity(const Activity& activity);
  void continue_with(SpringNetwork network, SimulatorSettings settings);
  template <class Change>
  void change_settings(const Change& change);
  void change_model(std::shared_ptr<const Model> next);
  void change_control(Control next);
  template <class Added>
  void add(std::vector<std::shared_ptr<Added>> Control::*list, std::shared_ptr<Added> added);
  template <class Added>
  void remove(std::vector<std::shared_ptr<Added>> Control::*list, const Added& added);

  std::unique_ptr<Scratch> scratch;
  std::shared_ptr<const Model> model;
  Control control;
  SimulationState state;
};

void Simulator::Implementation::wake() {
  stepper().wake_all();
  if (state.activity.asleep.empty()) return;
  const BeforeTransition before = stepper().before_transition();
  state.activity.asleep.clear();
  stepper().make_transition(before);
}

/// Wakes all particles and makes a change. If it throws, nothing has changed.
template <class Change>
void Simulator::Implementation::change_awake(const Change& change) {
  const SimulationState before = state;
  try {
    wake();
    change();
  } catch (...) {
    stepper().restore(before);
    throw;
  }
}

void Simulator::Implementation::change_activity(const Activity& activity) {
  const BeforeTransition before = stepper().before_transition();
  state.activity = activity;
  stepper().make_transition(before);
  stepper().note_change();
}

void Simulator::Implementation::continue_with(SpringNetwork network, SimulatorSettings settings) {
  check_change(network, settings, *model, state);
  change_awake([&] { change_model(Model::changed(*model, std::move(network), std::move(settings), control.forces)); });
}

/// `change` gets the present settings.
template <class Change>
void Simulator::Implementation::change_settings(const Change& change) {
  SimulatorSettings changed = scratch->settings;
  change(changed);
  continue_with(model->network(), std::move(changed));
}

void Simulator::Implementation::change_model(std::shared_ptr<const Model> next) {
  const BeforeTransition before = stepper().before_transition();
  SimulationState continued = continued_in(*next, *model, state);
  Control with_settings = control;  // the new model's settings have their own gravity and wind
  with_settings.gravity.reset();
  with_settings.wind.reset();
  auto its_scratch = std::make_unique<Scratch>(*next, with_settings, continued);
  Stepper(*next, with_settings, continued, *its_scratch).adopt(before, *model);
  control = std::move(with_settings);
  model = std::move(next);
  scratch = std::move(its_scratch);
  state = continued;
}

void Simulator::Implementation::change_control(Control next) {
  change_awake([&] {
    const BeforeTransition before = stepper().before_transition();
    SimulationState continued = state;
    continued.added_forces = next.forces.size();
    continued.added_constraints = next.constraints.size();
    auto its_scratch = std::make_unique<Scratch>(*model, next, continued);
    Stepper(*model, next, continued, *its_scratch).adopt(before, *model);
    control = std::move(next);
    scratch = std::move(its_scratch);
    state = continued;
  });
}

template <class Added>
void Simulator::Implementation::add(std::vector<std::shared_ptr<Added>> Control::*list, std::shared_ptr<Added> added) {
  check_added(added, control, network());
  Control next = control;
  (next.*list).push_back(std::move(added));
  next.touched = checked_touched(next, network());
  if (bounds_step(*(next.*list).back())) {
    check_step(scratch->settings, simulation_bounds(model->network(), scratch->settings, !scratch->obstacles.empty(), next.forces));
  }
  change_control(std::move(next));
}

template <class Added>
void Simulator::Implementation::remove(std::vector<std::shared_ptr<Added>> Control::*list, const Added& added) {
  Control next = control;
  if (std::erase_if(next.*list, [&](const auto& other) { return other.get() == &added; }) == 0) return;
  next.touched = checked_touched(next, network());
  change_control(std::move(next));
}

Simulator::Simulator(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles)
    : Simulator(std::move(network), std::move(settings), std::move(obstacles), StartState()) {}
Simulator::Simulator(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles, const StartState& start)
    : implementation_(std::make_unique<Implementation>(std::move(network), std::move(settings), std::move(obstacles), start)) {}
Simulator::Simulator(const std::shared_ptr<const Model>& model)
    : implementation_(std::make_unique<Implementation>(model, Control(), model->initial_state())) {}
Simulator::Simulator(const Simulator& other)
    : implementation_(std::make_unique<Implementation>(other.implementation_->model, other.implementation_->control,
                                                       other.implementation_->state)) {
  implementation_->stepper().load_caches(other.implementation_->stepper().caches());
  stop_when({});
}
Simulator& Simulator::operator=(const Simulator& other) {
  if (this != &other) *this = Simulator(other);
  return *this;
}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

void Simulator::restore(const SimulationState& state) {
  const Workspace& work = *implementation_->scratch->work;
  const Control& control = implementation_->control;
  check_state({.model = *model(),
               .control = control,
               .sleep_groups = implementation_->scratch->structure->groups.count(),
               .can_collide = work.constraints.contacts().can_collide()},
              state);
  implementation_->stepper().restore(state);
  if (records_as(settings(), state.impulses)) return;
  implementation_->state.impulses = implementation_->state.last_impulses = {};
  implementation_->stepper().begin_recording();
}

Checkpoint Simulator::checkpoint() const {
  Checkpoint checkpoint;
  checkpoint.bodies = bodies_of(model()->network());
  for (const Obstacle& obstacle : obstacles()) checkpoint.obstacles.push_back({obstacle.name});
  checkpoint.state = state();
  checkpoint.caches = implementation_->stepper().caches();
  checkpoint.model = fingerprint_of(*model());
  return checkpoint;
}

void Simulator::restore(const Checkpoint& checkpoint) {
  std::vector<Problem> problems;
  for (const std::string& difference : differences(checkpoint.bodies, bodies_of(model()->network()))) {
    problems.push_back({"", "checkpoint", "", difference, "load it into a simulator of the same network"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  restore(checkpoint.state);
  if (checkpoint.model == fingerprint_of(*model())) implementation_->stepper().load_caches(checkpoint.caches);
}

void Simulator::save(const std::filesystem::path& file) const { write_checkpoint(file, checkpoint()); }

void Simulator::load(const std::filesystem::path& file) { restore(read_checkpoint(file)); }

StepReport Simulator::step() { return implementation_->stepper().step(); }

void Simulator::stop_when(std::function<bool()> stops) { implementation_->control.stops = std::move(stops); }

void Simulator::wake() {
  implementation_->control.touched = checked_touched(implementation_->control, network());
  implementation_->scratch->work->note_touched(implementation_->control.touched, implementation_->scratch->structure->groups);
  implementation_->wake();
}

void Simulator::continue_with(SpringNetwork network, SimulatorSettings settings) {
  implementation_->continue_with(std::move(network), std::move(settings));
}

void Simulator::set_gravity(const Vector3& acceleration) {
  if (!acceleration.allFinite() || settings().air_surface.quadratic) {  // the largest stable step counts on the speed of a fall
    implementation_->change_settings([&](SimulatorSettings& changed) { changed.gravity = acceleration; });
    return;
  }
  implementation_->control.gravity = acceleration;
  implementation_->stepper().follow_conditions();
}

void Simulator::set_air(double drag, const Wind& wind) {
  // The largest stable step counts on the usual speed of the wind where drag is quadratic.
  const bool faster = has_own_drag(network()) && wind.usual_speed() > model()->settings().wind.usual_speed();
  if (drag != settings().air_drag || settings().air_surface.quadratic || faster) {
    implementation_->change_settings([&](SimulatorSettings& changed) {
      changed.air_drag = drag;
      changed.wind = wind;
    });
    return;
  }
  ProblemList problems;
  check_wind(wind, problems);
  problems.throw_if_any();
  implementation_->control.wind = wind;
  implementation_->stepper().follow_conditions();
}

void Simulator::set_stretch_limit(const std::optional<StretchLimitSettings>& limit) {
  implementation_->change_settings([&](SimulatorSettings& changed) { changed.stretch_limit = limit; });
}

void Simulator::set_springs(std::size_t body, SpringKind kind, double stiffness, double damping) {
  SpringNetwork network = model()->network();
  check_number_of("kinds of springs", "a kind of springs", static_cast<std::size_t>(kind), kSpringKindNames.size());
  check_number_of("bodies", "a body", body, network.bodies.size());
  const Body& changed = network.bodies[body];
  const std::string key = "bodies." + changed.name + ".springs." + kSpringKindNames[static_cast<std::size_t>(kind)];
  ProblemList problems;
  check_number(key + ".stiffness", stiffness, problems);
  check_number(key + ".damping", damping, problems);
  Springs& springs = network.springs;
  bool any = false;
  for (Index s = changed.first_spring; s < changed.first_spring + changed.spring_count; ++s) {
    if (springs.kind[s] != kind) continue;
    any = true;
    springs.stiffness[s] = stiffness;
    springs.damping[s] = damping;
  }
  if (!any) problems.add(key, "", "has no springs", "build the body with springs of this kind");
  problems.throw_if_any();
  implementation_->continue_with(std::move(network), settings());
}

void Simulator::set_body_material(std::size_t body, const ContactMaterial& material) {
  SpringNetwork network = model()->network();
  check_number_of("bodies", "a body", body, network.bodies.size());
  Body& changed = network.bodies[body];
  ProblemList problems;
  check_material("bodies." + changed.name, material, problems);
  problems.throw_if_any();
  changed.material = material;
  implementation_->continue_with(std::move(network), settings());
}

void Simulator::set_obstacle_material(std::size_t obstacle, const ContactMaterial& material) {
  check_number_of("obstacles", "an obstacle", obstacle, obstacles().size());
  ProblemList problems;
  check_material(obstacle_key(obstacles()[obstacle], obstacle), material, problems);
  problems.throw_if_any();
  Control control = implementation_->control;
  control.obstacle_materials.clear();
  for (const Obstacle& present : obstacles()) control.obstacle_materials.push_back(present.material);
  control.obstacle_materials[obstacle] = material;
  if (material.thickness != obstacles()[obstacle].material.thickness) {  // regions and searches depend on it
    implementation_->change_control(std::move(control));
    return;
  }
  implementation_->control = std::move(control);
  implementation_->scratch->obstacles.set_material(static_cast<Index>(obstacle), material);
  implementation_->stepper().wake_all();
}

void Simulator::set_motion(const Points& positions, const Points& velocities) {
  check_motion(network(), state(), positions, velocities);
  const bool moves = positions != state().x;
  if (!moves && velocities == state().v) return;
  if (moves) check_moved(network(), obstacle_frame(), settings().contact, state().x, positions);
  implementation_->wake();
  implementation_->stepper().set_motion(positions, velocities);
}

std::size_t Simulator::pin(Index particle) {
  check_particle(network(), particle);
  if (state().activity.is_pinned(particle)) return static_cast<std::size_t>(state().activity.pin_of[particle]);
  const Body& body = network().body_of(particle);
  const std::string first_choice = body.name + ".particles[" + std::to_string(particle - body.first_particle) + "]";
  std::string name = first_choice;
  for (int k = 2; !is_free_for(particle, name, *model(), state()); ++k) name = first_choice + " (" + std::to_string(k) + ")";
  return pin({particle}, name);
}

std::size_t Simulator::pin(const std::vector<Index>& particles, const std::string& name) {
  check_pin(model()->network(), particles, name);
  const auto known = std::ranges::find(network().pins, name, &Pin::name);
  const auto number = static_cast<std::size_t>(known - network().pins.begin());
  implementation_->change_awake([&] {
    const BeforeTransition before = implementation_->stepper().before_transition();
    SimulationState& state = implementation_->state;
    if (known == network().pins.end()) {
      Pin& added = state.steering.added_pins.emplace_back();
      added.name = name;
      state.activity.phases.push_back(PinPhase::holding);
    }
    Pin& added = state.steering.added_pins[number - model()->network().pins.size()];
    added.particles = particles;
    added.from = time();
    added.origin = state.x(Eigen::all, particles).rowwise().mean();
    std::erase_if(state.steering.pins, [&](const SteeredMotion& steered) { return steered.number == number; });
    std::ranges::replace(state.activity.pin_of, static_cast<Index>(number), kNone);
    for (const Index i : particles) {
      if (!state.activity.is_pinned(i)) state.activity.pin_of[i] = static_cast<Index>(number);
    }
    implementation_->stepper().make_transition(before);
    implementation_->stepper().note_change();
  });
  return number;
}

void Simulator::release(Index particle) {
  check_particle(network(), particle);
  const Index pin = state().activity.pin_of[particle];
  if (pin == kNone) return;
  Activity activity = state().activity;
  activity.asleep.clear();
  activity.pin_of[particle] = kNone;
  if (static_cast<std::size_t>(pin) < model()->network().pins.size() && network().pins[pin].holds_always()) {
    SpringNetwork freed = model()->network();  // the largest stable step counts on this pin
    set_activity(activity, freed);
    check_step(settings(), simulation_bounds(freed, settings(), !obstacles().empty(), implementation_->control.forces));
  }
  implementation_->change_awake([&] { implementation_->change_activity(activity); });
}

RigidTransform Simulator::pin_pose(std::size_t pin) const {
  check_number_of("pins", "a pin", pin, network().pins.size());
  const Pin& its = network().pins[pin];
  if (its.obstacle != kNone) return obstacle_pose(static_cast<std::size_t>(its.obstacle));
  return its.motion.pose(RigidTransform(Eigen::Translation3d(its.origin)), time());
}

RigidTransform Simulator::obstacle_pose(std::size_t obstacle) const {
  check_number_of("obstacles", "an obstacle", obstacle, obstacles().size());
  return obstacles()[obstacle].motion.pose(obstacles()[obstacle].rest_pose, time());
}

void Simulator::move_pin(std::size_t pin, const RigidTransform& pose) {
  const RigidTransform present = pin_pose(pin);
  const Pin& moved = network().pins[pin];
  const std::string key = "pins." + moved.name + ".pose";
  if (moved.obstacle != kNone) {
    const auto obstacle = static_cast<std::size_t>(moved.obstacle);
    throw InputError({.key = key,
                      .value = vector_text(pose.translation()),
                      .rule = "cannot be given: the pin follows " + obstacle_key(obstacles()[obstacle], obstacle),
                      .remedy = "move the obstacle"});
  }
  const bool begins =
      state().activity.phases[pin] == PinPhase::waiting && moved.from < due_before(whole_steps(state()), settings().step);
  const std::vector<Index> held = begins ? moved.particles : held_particles(network(), pin);
  if (held.empty()) {
    throw InputError({.key = key,
                      .value = vector_text(pose.translation()),
                      .rule = "cannot be given: the pin holds no particle now",
                      .remedy = "move it while it holds one, or pin particles with pin()"});
  }
  double reach = 0.0;
  for (const Index i : held) reach = std::max(reach, (state().x.col(i) - present.translation()).norm());
  check_move(key, present, pose, reach, model()->network());
  implementation_->stepper().steer(&Steering::pins, pin, present, pose);
}

void Simulator::move_obstacle(std::size_t obstacle, const RigidTransform& pose) {
  const RigidTransform present = obstacle_pose(obstacle);
  const std::string key = obstacle_key(obstacles()[obstacle], obstacle) + ".pose";
  const Box3 box = implementation_->scratch->obstacles.shape(static_cast<Index>(obstacle)).bounds();
  const double reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
  check_move(key, present, pose, std::isfinite(reach) ? reach : 0.0, model()->network());  // a half-space has no end
  implementation_->stepper().steer(&Steering::obstacles, obstacle, present, pose);
}

void Simulator::add_force(std::shared_ptr<Force> force) { implementation_->add(&Control::forces, std::move(force)); }
void Simulator::remove_force(const Force& force) { implementation_->remove(&Control::forces, force); }
void Simulator::add_constraint(std::shared_ptr<Constraint> constraint) {
  implementation_->add(&Control::constraints, std::move(constraint));
}
void Simulator::remove_constraint(const Constraint& constraint) { implementation_->remove(&Control::constraints, constraint); }

const std::shared_ptr<const Model>& Simulator::model() const { return implementation_->model; }
const SpringNetwork& Simulator::network() const { return implementation_->network(); }
const SimulatorSettings& Simulator::settings() const { return implementation_->scratch->settings; }
const SimulationState& Simulator::state() const { return implementation_->state; }
const std::vector<Obstacle>& Simulator::obstacles() const { return implementation_->scratch->obstacles.obstacles(); }
ObstacleFrame Simulator::obstacle_frame() const { return implementation_->stepper().obstacles_now(); }
const std::vector<std::string>& Simulator::warnings() const { return model()->warnings(); }
const std::vector<std::string>& Simulator::notes() const { return model()->notes(); }
double Simulator::time() const { return implementation_->stepper().time(); }
double Simulator::gravity_energy() const { return implementation_->stepper().energy(EnergyKind::gravity); }
double Simulator::elastic_energy() const { return implementation_->stepper().energy(EnergyKind::elastic); }
double Simulator::contact_energy() const { return implementation_->stepper().energy(EnergyKind::contact); }

std::vector<Reaction> Simulator::reactions() const {
  if (!state().impulses.on()) return {};
  return mean_reactions(network(), state(), time() - state().reactions.since);
}

Scalars Simulator::limit_tensions() const {
  const double duration = time() - state().reactions.since;
  if (!state().impulses.on() || duration <= 0.0) return Scalars::Zero(network().springs.count());
  return state().impulses.of_springs / duration;
}

Points Simulator::contact_forces() const {
  const double duration = time() - state().reactions.since;
  if (!state().impulses.has_contact() || duration <= 0.0) return Points::Zero(3, network().particle_count());
  return state().impulses.of_contact / duration;
}

void Simulator::reset_forces() { implementation_->stepper().begin_recording(); }

std::string Simulator::stretch_solver() const {
  const StretchLimit* limit = implementation_->scratch->work->constraints.limit();
  return limit != nullptr ? limit->chosen_solver() : std::string();
}

std::vector<BrokenLink> Simulator::broken_links() const {
  std::vector<BrokenLink> broken;
  for (const Link& link : state().links) {
    if (link.broken) broken.push_back({network().attachments[link.attachment].name, link.first, *link.broken});
  }
  return broken;
}

std::vector<Index> Simulator::contact_particles() const { return implementation_->stepper().contacts(); }
Index Simulator::contact_count() const { return static_cast<Index>(contact_particles().size()); }
void Simulator::check() const { implementation_->stepper().check(); }

}  // namespace sprung
