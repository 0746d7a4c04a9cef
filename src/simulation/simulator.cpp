#include "simulation/simulator.h"

#include "base/format.h"
#include "base/problem_list.h"
#include "geometry/motion/motion_check.h"
#include "network/model/spring_failure.h"
#include "simulation/reaction_record.h"
#include "simulation/state_check.h"
#include "simulation/step/step_check.h"
#include "simulation/stepper.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace sprung {
namespace {

bool have_same_bodies(const SpringNetwork& a, const SpringNetwork& b) {
  return std::ranges::equal(a.bodies, b.bodies, [](const Body& first, const Body& second) {
    return first.name == second.name && first.first_particle == second.first_particle &&
           first.particle_count == second.particle_count;
  });
}

bool collide_alike(const SpringNetwork& a, const SpringNetwork& b) {
  return std::ranges::equal(a.bodies, b.bodies, [](const Body& first, const Body& second) {
    return first.contact.self == second.contact.self && first.contact.others == second.contact.others;
  });
}

bool have_same_pins(const SpringNetwork& a, const SpringNetwork& b) {
  return std::ranges::equal(a.pins, b.pins, [](const Pin& first, const Pin& second) {
    return first.name == second.name && first.particles == second.particles && first.from == second.from &&
           first.until == second.until;
  });
}

// Time is counted in frames, and within a frame in steps.
void check_step_change(const SimulatorSettings& settings, const SimulatorSettings& before, const SimulationState& state,
                       ProblemList& problems) {
  if (settings.step == before.step && settings.steps_per_frame == before.steps_per_frame) return;
  const double frame = before.step * before.steps_per_frame;
  constexpr double kRounding = 1.0e-9;
  if (std::abs(settings.step * settings.steps_per_frame - frame) > kRounding * frame) {
    problems.add("step", format_number(settings.step, 6),
                 "times steps_per_frame must stay a frame of " + format_number(frame, 6) + " s, as the run goes on",
                 "change both, or begin a new run");
  } else if (state.step_in_frame != 0) {
    problems.add("step", format_number(settings.step, 6), "may change at the end of a frame alone, as the run goes on",
                 "make the other steps of the frame first");
  }
}

// The cached contacts and permitted crossings of a run belong to its elements.
void check_change(const SpringNetwork& network, const SimulatorSettings& settings, const Model& before,
                  const SimulationState& state) {
  const std::string restart = "begin a new run";
  ProblemList problems;
  if (!have_same_bodies(network, before.network())) {
    problems.add("bodies", "", "must have the same names and particles as before, as the run goes on", restart);
  } else if (!collide_alike(network, before.network())) {
    problems.add("contact", "", "must be asked for between the same bodies as before, as the run goes on", restart);
  }
  check_step_change(settings, before.settings(), state, problems);
  if (settings.contact.response != before.settings().contact.response) {
    problems.add("contact.response", "", "must stay as it is, as the run goes on", restart);
  }
  problems.throw_if_any();
}

/// Pins that a program added, and those of the same name and particles that it steers, go on in a model with other pins.
void keep_pins(const std::vector<Pin>& before, const std::vector<Pin>& after, const std::vector<Index>& pin_of,
               SimulationState& state) {
  Steering& steering = state.steering;
  std::vector<SteeredMotion> kept;
  for (SteeredMotion& steered : steering.pins) {
    if (steered.number >= before.size()) {
      steered.number += after.size() - before.size();
    } else {
      const Pin& its = before[steered.number];
      const auto same = std::ranges::find_if(
          after, [&](const Pin& pin) { return pin.name == its.name && pin.particles == its.particles && pin.from == its.from; });
      if (same == after.end()) continue;
      steered.number = static_cast<std::size_t>(same - after.begin());
    }
    kept.push_back(std::move(steered));
  }
  std::ranges::sort(kept, {}, &SteeredMotion::number);
  steering.pins = std::move(kept);
  state.activity.phases.insert(state.activity.phases.end(), steering.added_pins.size(), PinPhase::holding);
  for (std::size_t i = 0; i < pin_of.size(); ++i) {
    const auto pin = static_cast<std::size_t>(pin_of[i]);
    if (pin_of[i] != kNone && pin >= before.size()) {
      state.activity.pin_of[i] = static_cast<Index>(pin + after.size() - before.size());
    }
  }
}

void check_entry(const std::string& key, std::size_t number, std::size_t count) {
  if (number < count) return;
  throw InputError(
      {.key = key, .value = std::to_string(number), .rule = "there are only " + std::to_string(count), .remedy = "count from 0"});
}

void check_number(const std::string& key, double number, ProblemList& problems) {
  if (std::isfinite(number) && number >= 0.0) return;
  problems.add(key, format_number(number, 6), "must be finite and not negative", "give 0 for none");
}

void check_pose(const std::string& key, const RigidTransform& pose) {
  if (is_rigid(pose)) return;
  if (!pose.matrix().allFinite()) {
    throw InputError({.key = key,
                      .value = pose.linear().allFinite() ? vector_text(pose.translation()) : "a rotation that is not finite",
                      .rule = "must be finite",
                      .remedy = "give a position in m and a rotation"});
  }
  const Matrix3 linear = pose.linear();
  const double off = (linear.transpose() * linear - Matrix3::Identity()).norm();
  throw InputError({.key = key,
                    .value = linear.determinant() < 0.0 ? "a reflection" : "a matrix R with |R^T R - I| = " + format_number(off, 3),
                    .rule = "must be a rotation and a translation",
                    .remedy = "leave out scale, shear and reflection; the normalized quaternion of R gives a rotation"});
}

/// Bound of the length [m] of the paths of points that are up to `reach` [m] from the origin of a pose, as it moves.
double travel(const RigidTransform& from, const RigidTransform& to, double reach) {
  const double angle = Eigen::Quaterniond(from.linear()).angularDistance(Eigen::Quaterniond(to.linear()));
  return (to.translation() - from.translation()).stableNorm() + angle * reach;
}

/// The diagonal [m] of the largest of the boxes around each body at the start.
double largest_size(const SpringNetwork& network) {
  double largest = 0.0;
  for (const Body& body : network.bodies) {
    const auto positions = network.positions.middleCols(body.first_particle, body.particle_count);
    largest = std::max(largest, (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).norm());
  }
  return largest;
}

/// One step must not stretch a body to more than twice its size.
void check_travel(const std::string& key, double distance, const SpringNetwork& network) {
  constexpr double kRounding = 1.0e-9;
  const double most = largest_size(network);
  if (most == 0.0 || distance <= (1.0 + kRounding) * most) return;  // without springs nothing is stretched
  throw InputError({.key = key,
                    .value = format_number(distance, 6) + " m from the present pose",
                    .rule = "must be at most " + format_number(most, 6) + " m away in one step, the size of the largest body",
                    .remedy = "go there in " + format_number(std::ceil(distance / most - kRounding)) + " steps"});
}

/// The first pose, and those at which pins took particles before `now` [s]: pins move these by what the pose changed since.
std::vector<TimedPose> poses_of_grips(const SteeredMotion& steered, const std::vector<PinGrip>& grips, double now) {
  const double first = steered.poses.front().time;
  std::set<double> times;
  for (const PinGrip& grip : grips) {
    if (grip.time > first && grip.time < now) times.insert(grip.time);
  }
  const Motion motion{.poses = steered.poses};
  std::vector<TimedPose> poses{steered.poses.front()};
  for (const double time : times) poses.push_back({time, motion.pose(steered.poses.front().pose, time)});
  return poses;
}

void check_particle(const SpringNetwork& network, Index particle) {
  if (particle >= 0 && particle < network.particle_count()) return;
  throw InputError({.key = "particle",
                    .value = std::to_string(particle),
                    .rule = "must be the number of a particle; there are " + std::to_string(network.particle_count()),
                    .remedy = "count particles from 0"});
}

/// `model` has the pins that no program added.
void check_pin(const SpringNetwork& model, const std::vector<Index>& particles, const std::string& name) {
  const std::string key = "pins." + name;
  ProblemList problems;
  const auto exists = [&](Index i) { return i >= 0 && i < model.particle_count(); };
  if (particles.empty()) problems.add(key, "", "must contain at least one particle", "name a particle");
  problems.require_each(
      particles.size(), [&](std::size_t k) { return exists(particles[k]); },
      [&](std::size_t k) { return std::to_string(particles[k]); },
      {key, "must be the number of a particle; there are " + std::to_string(model.particle_count()), "count particles from 0"});
  std::vector<Index> sorted = particles;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) problems.add(key, std::to_string(*twice), "must be named once", "remove the second one");
  const auto is_its = [&](const auto& named) { return named.name == name; };
  if (name.empty()) problems.add("pins", "\"\"", "must be a name, which its reaction has too", "name the pin");
  if (std::ranges::any_of(model.pins, is_its)) {
    problems.add(key, "", "is the name of a pin of the network already", "choose another name, or move that pin");
  }
  if (std::ranges::any_of(model.attachments, is_its)) {
    problems.add(key, "", "is the name of an attachment already", "choose another name");
  }
  problems.throw_if_any();
}

}  // namespace

struct Simulator::Implementation {
  Implementation(std::shared_ptr<const Model> shared, Control chosen, const SimulationState& from)
      : model(std::move(shared)), control(std::move(chosen)), state(from) {
    scratch = std::make_unique<Scratch>(*model, control, state);
    stepper().enter();
  }
  /// At the start.
  Implementation(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles)
      : model(Model::build(std::move(network), std::move(settings), std::move(obstacles), scratch)),
        state(model->initial_state()) {}

  Stepper stepper() { return {*model, control, state, *scratch}; }
  [[nodiscard]] const SpringNetwork& network() const { return scratch->network; }

  void wake();
  template <class Change>
  void change_awake(const Change& change);
  void change_activity(const Activity& activity);
  void follow_conditions();
  void steer(std::vector<SteeredMotion> Steering::*list, std::size_t number, const RigidTransform& present,
             const RigidTransform& target);
  void change_model(std::shared_ptr<const Model> next);
  void change_control(Control next);

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
  stepper().note_change();
}

void Simulator::Implementation::change_activity(const Activity& activity) {
  const BeforeTransition before = stepper().before_transition();
  state.activity = activity;
  stepper().make_transition(before);
}

/// Lets forces know gravity and wind. All particles wake in the next step.
void Simulator::Implementation::follow_conditions() {
  scratch->follow_conditions(control);
  state.energy.is_stale = true;
  stepper().wake_all();
}

/// Moves a pin or an obstacle in the next step.
void Simulator::Implementation::steer(std::vector<SteeredMotion> Steering::*list, std::size_t number, const RigidTransform& present,
                                      const RigidTransform& target) {
  std::vector<SteeredMotion>& all = state.steering.*list;
  const double now = stepper().time();
  const double end = static_cast<double>(whole_steps(state) + 1) * model->settings().step;
  auto steered = std::ranges::lower_bound(all, number, {}, &SteeredMotion::number);
  const bool is_new = steered == all.end() || steered->number != number;
  if (is_new) steered = all.insert(steered, {.number = number, .poses = {{now, present}}});
  const BeforeTransition before = is_new ? stepper().before_transition() : BeforeTransition();
  std::vector<TimedPose> poses = poses_of_grips(*steered, state.grips, now);
  if (now > poses.front().time) poses.push_back({now, present});
  poses.push_back({end, target});
  steered->poses = std::move(poses);
  if (is_new) {
    stepper().make_transition(before);
  } else {
    stepper().follow_steering();
  }
}

void Simulator::Implementation::change_model(std::shared_ptr<const Model> next) {
  const BeforeTransition before = stepper().before_transition();
  SimulationState continued = state;
  continued.springs = carried_over(model->network(), state.springs, next->network());
  if (!have_same_pins(model->network(), next->network())) {
    continued.activity = all_free(next->network());
    keep_pins(model->network().pins, next->network().pins, state.activity.pin_of, continued);
    change_pins(next->network().pins, due_before(whole_steps(state), model->settings().step), continued.activity);
  }
  Control with_settings = control;  // the new model's settings have their own gravity and wind
  with_settings.gravity.reset();
  with_settings.wind.reset();
  auto its_scratch = std::make_unique<Scratch>(*next, with_settings, continued);
  Stepper(*next, with_settings, continued, *its_scratch).inherit(before, *model);
  control = std::move(with_settings);
  model = std::move(next);
  scratch = std::move(its_scratch);
  state = continued;
}

void Simulator::Implementation::change_control(Control next) {
  const BeforeTransition before = stepper().before_transition();
  SimulationState continued = state;
  continued.added_forces = next.forces.size();
  continued.added_constraints = next.constraints.size();
  auto its_scratch = std::make_unique<Scratch>(*model, next, continued);
  Stepper(*model, next, continued, *its_scratch).inherit(before, *model);
  control = std::move(next);
  scratch = std::move(its_scratch);
  state = continued;
}

Simulator::Simulator(SpringNetwork network, SimulatorSettings settings, std::vector<Obstacle> obstacles)
    : implementation_(std::make_unique<Implementation>(std::move(network), std::move(settings), std::move(obstacles))) {}
Simulator::Simulator(const std::shared_ptr<const Model>& model)
    : implementation_(std::make_unique<Implementation>(model, Control(), model->initial_state())) {}
Simulator::Simulator(const Simulator& other)
    : implementation_(std::make_unique<Implementation>(other.implementation_->model, other.implementation_->control,
                                                       other.implementation_->state)) {}
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
  if (settings().record_forces == state.impulses.on()) return;
  implementation_->state.impulses = implementation_->state.last_impulses = {};
  implementation_->stepper().begin_recording();
}

StepReport Simulator::step() { return implementation_->stepper().step(); }

void Simulator::stop_when(std::function<bool()> stops) { implementation_->control.stops = std::move(stops); }

void Simulator::wake() { implementation_->wake(); }

void Simulator::continue_with(SpringNetwork network, SimulatorSettings settings) {
  check_change(network, settings, *model(), state());
  implementation_->change_awake([&] {
    implementation_->change_model(
        Model::changed(*model(), std::move(network), std::move(settings), implementation_->control.forces));
  });
}

void Simulator::set_gravity(const Vector3& acceleration) {
  if (!acceleration.allFinite() || settings().air_surface.quadratic) {  // the largest stable step counts on the speed of a fall
    SimulatorSettings changed = settings();
    changed.gravity = acceleration;
    continue_with(model()->network(), std::move(changed));
    return;
  }
  implementation_->control.gravity = acceleration;
  implementation_->follow_conditions();
}

void Simulator::set_air(double drag, const Wind& wind) {
  if (drag != settings().air_drag || settings().air_surface.quadratic || !std::isfinite(wind.max_speed())) {
    SimulatorSettings changed = settings();
    changed.air_drag = drag;
    changed.wind = wind;
    continue_with(model()->network(), std::move(changed));
    return;
  }
  implementation_->control.wind = wind;
  implementation_->follow_conditions();
}

void Simulator::set_stretch_limit(const std::optional<StretchLimitSettings>& limit) {
  SimulatorSettings changed = settings();
  changed.stretch_limit = limit;
  continue_with(model()->network(), std::move(changed));
}

void Simulator::set_springs(std::size_t body, SpringKind kind, double stiffness, double damping) {
  SpringNetwork network = model()->network();
  check_entry("bodies", body, network.bodies.size());
  const Body& changed = network.bodies[body];
  const std::string key = "bodies." + changed.name + ".springs." + kSpringKindNames[static_cast<std::size_t>(kind)];
  ProblemList problems;
  check_number(key + ".stiffness", stiffness, problems);
  check_number(key + ".damping", damping, problems);
  problems.throw_if_any();
  Springs& springs = network.springs;
  for (Index s = changed.first_spring; s < changed.first_spring + changed.spring_count; ++s) {
    if (springs.kind[s] != kind) continue;
    springs.stiffness[s] = stiffness;
    springs.damping[s] = damping;
  }
  continue_with(std::move(network), settings());
}

void Simulator::set_body_material(std::size_t body, const ContactMaterial& material) {
  SpringNetwork network = model()->network();
  check_entry("bodies", body, network.bodies.size());
  Body& changed = network.bodies[body];
  ProblemList problems;
  check_material("bodies." + changed.name, material, problems);
  problems.throw_if_any();
  changed.material = material;
  continue_with(std::move(network), settings());
}

void Simulator::set_obstacle_material(std::size_t obstacle, const ContactMaterial& material) {
  check_entry("obstacles", obstacle, obstacles().size());
  ProblemList problems;
  check_material("obstacles." + obstacles()[obstacle].name, material, problems);
  problems.throw_if_any();
  Control control = implementation_->control;
  control.obstacle_materials.clear();
  for (const Obstacle& present : obstacles()) control.obstacle_materials.push_back(present.material);
  control.obstacle_materials[obstacle] = material;
  if (material.thickness != obstacles()[obstacle].material.thickness) {  // regions and searches depend on it
    implementation_->change_awake([&] { implementation_->change_control(std::move(control)); });
    return;
  }
  implementation_->control = std::move(control);
  implementation_->scratch->obstacles.set_material(static_cast<Index>(obstacle), material);
  implementation_->stepper().wake_all();
}

std::size_t Simulator::pin(Index particle) {
  check_particle(network(), particle);
  if (state().activity.is_pinned(particle)) return static_cast<std::size_t>(state().activity.pin_of[particle]);
  const Body& body = network().body_of(particle);
  return pin({particle}, body.name + ".particles[" + std::to_string(particle - body.first_particle) + "]");
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
  check_entry("pins", pin, network().pins.size());
  const Pin& its = network().pins[pin];
  if (its.obstacle != kNone) return obstacle_pose(static_cast<std::size_t>(its.obstacle));
  return its.motion.pose(RigidTransform(Eigen::Translation3d(its.origin)), time());
}

RigidTransform Simulator::obstacle_pose(std::size_t obstacle) const {
  check_entry("obstacles", obstacle, obstacles().size());
  return obstacles()[obstacle].motion.pose(obstacles()[obstacle].rest_pose, time());
}

void Simulator::move_pin(std::size_t pin, const RigidTransform& pose) {
  const RigidTransform present = pin_pose(pin);
  const Pin& moved = network().pins[pin];
  const std::string key = "pins." + moved.name + ".pose";
  if (moved.obstacle != kNone) {
    const std::string& obstacle = obstacles()[static_cast<std::size_t>(moved.obstacle)].name;
    throw InputError({.key = key,
                      .value = vector_text(pose.translation()),
                      .rule = "cannot be given: the pin follows the obstacle \"" + obstacle + "\"",
                      .remedy = "move the obstacle"});
  }
  check_pose(key, pose);
  double reach = 0.0;
  for (const Index i : held_particles(network(), pin)) {
    reach = std::max(reach, (state().x.col(i) - present.translation()).norm());
  }
  check_travel(key, travel(present, pose, reach), model()->network());
  implementation_->steer(&Steering::pins, pin, present, pose);
}

void Simulator::move_obstacle(std::size_t obstacle, const RigidTransform& pose) {
  const RigidTransform present = obstacle_pose(obstacle);
  const std::string key = "obstacles." + obstacles()[obstacle].name + ".pose";
  check_pose(key, pose);
  const Box3 box = implementation_->scratch->obstacles.shape(static_cast<Index>(obstacle)).bounds();
  const double reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
  check_travel(key, travel(present, pose, std::isfinite(reach) ? reach : 0.0), model()->network());  // a half-space has no end
  implementation_->steer(&Steering::obstacles, obstacle, present, pose);
}

void Simulator::add_force(std::shared_ptr<Force> force) {
  Control control = implementation_->control;
  control.forces.push_back(std::move(force));
  std::vector<LinearElement> elements;
  control.forces.back()->append_elements(elements);
  if (!elements.empty()) {
    check_step(settings(), simulation_bounds(model()->network(), settings(), !obstacles().empty(), control.forces));
  }
  implementation_->change_awake([&] { implementation_->change_control(std::move(control)); });
}

void Simulator::remove_force(const Force& force) {
  Control control = implementation_->control;
  const auto is_it = [&](const std::shared_ptr<Force>& added) { return added.get() == &force; };
  if (std::erase_if(control.forces, is_it) == 0) return;
  implementation_->change_awake([&] { implementation_->change_control(std::move(control)); });
}

void Simulator::add_constraint(std::shared_ptr<Constraint> constraint) {
  Control control = implementation_->control;
  control.constraints.push_back(std::move(constraint));
  implementation_->change_awake([&] { implementation_->change_control(std::move(control)); });
}

void Simulator::remove_constraint(const Constraint& constraint) {
  Control control = implementation_->control;
  const auto is_it = [&](const std::shared_ptr<Constraint>& added) { return added.get() == &constraint; };
  if (std::erase_if(control.constraints, is_it) == 0) return;
  implementation_->change_awake([&] { implementation_->change_control(std::move(control)); });
}

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
