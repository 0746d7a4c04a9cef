#include "viewer/live/live_run.h"

#include "base/error.h"
#include "scene/json/overrides.h"
#include "simulation/model.h"
#include "viewer/live/shown_simulator.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace sprung {
namespace {

/// The key of `key.path=json`.
std::string_view key_of(const std::string& override_text) {
  return std::string_view(override_text).substr(0, override_text.find('='));
}

std::vector<std::string_view> names_of(std::string_view key) {
  std::vector<std::string_view> names;
  while (true) {
    const std::size_t dot = key.find('.');
    names.push_back(key.substr(0, dot));
    if (dot == std::string_view::npos) return names;
    key.remove_prefix(dot + 1);
  }
}

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> all) {
  return std::ranges::find(all, name) != all.end();
}

/// Whether a run may continue with a change of this key.
bool is_live(std::string_view key) {
  const std::vector<std::string_view> names = names_of(key);
  if (is_one_of(names[0], {"gravity", "air", "stretch_limit", "step", "stability"})) return true;
  if (names.size() < 3 || !is_one_of(names[0], {"bodies", "obstacles"})) return false;
  if (names[0] == "bodies" && names[2] == "springs") return true;
  return names.size() == 3 && is_one_of(names[2], {"friction", "static_friction", "restitution", "thickness"});
}

/// Whether a later change of `key` leaves nothing of this one.
bool is_replaced(const std::string& override_text, std::string_view key) {
  const std::string_view own = key_of(override_text);
  return own.starts_with(key) && (own.size() == key.size() || own[key.size()] == '.' || own[key.size()] == '[');
}

/// Where the scenes have the same bodies, particles have the same numbers.
bool have_same_bodies(const SpringNetwork& a, const SpringNetwork& b) {
  return std::ranges::equal(a.bodies, b.bodies, [](const Body& one, const Body& other) {
    return one.name == other.name && one.particle_count == other.particle_count;
  });
}

/// Adds the particles that the hand pinned to the pins of a scene, body by body.
void add_pins(const SpringNetwork& network, const std::set<Index>& pinned, nlohmann::ordered_json& scene) {
  for (const Body& body : network.bodies) {
    nlohmann::ordered_json indices = nlohmann::ordered_json::array();
    for (const Index i : pinned) {
      if (i >= body.first_particle && i < body.first_particle + body.particle_count) indices.push_back(i - body.first_particle);
    }
    if (indices.empty()) continue;
    nlohmann::ordered_json& pins = scene["bodies"][body.name]["pins"];
    if (!pins.is_array()) pins = nlohmann::ordered_json::array();
    pins.push_back({{"indices", std::move(indices)}});
  }
}

/// Continues with the steps of the run, in inner substeps that are no longer than those of the settings.
SimulatorSettings with_steps_of(const SimulatorSettings& run, SimulatorSettings settings) {
  const double longest = settings.longest_substep();
  settings.step = run.step;
  if (settings.inner_substeps > 1) {
    constexpr double kRounding = 1.0e-9;
    const double needed = std::ceil(run.step / longest - kRounding);
    settings.inner_substeps = static_cast<int>(std::clamp(needed, 1.0, static_cast<double>(kMaxInnerSubsteps)));
  }
  settings.steps_per_frame = run.steps_per_frame;
  return settings;
}

/// Replaces the file by its text.
const SceneSource& read_text(SceneSource& source) {
  source.text = scene_text(source);
  return source;
}

/// A page shows forces of contact.
PreparedScene prepare(const SceneSource& source) {
  PreparedScene prepared = prepare_scene(source);
  prepared.built.settings.record_contact_forces = true;
  return prepared;
}

}  // namespace

// The text is read once, so that a file that changes meanwhile does not change the run.
LiveRun::LiveRun(SceneSource source) : source_(std::move(source)), loaded_(start_scene(prepare(read_text(source_)))) {
  recording_.begin(simulator(), hand_);
}

std::string LiveRun::changed_scene(const std::string& initial_state) const {
  JsonText json = parse_json(scene_text(source_), source_.file);
  std::vector<Problem> problems;
  for (const std::string& change : source_.overrides) apply_override(change, json.document, problems);
  add_pins(simulator().network(), hand_.pinned, json.document);
  if (!initial_state.empty()) json.document["initial_state"] = initial_state;
  return json_text(json.document);
}

bool LiveRun::change(const std::vector<std::string>& overrides) {
  SceneSource source = source_;
  for (const std::string& change : overrides) {
    std::erase_if(source.overrides, [&](const std::string& earlier) { return is_replaced(earlier, key_of(change)); });
    source.overrides.push_back(change);
  }
  PreparedScene changed = prepare(source);
  const bool live = std::ranges::all_of(overrides, [](const std::string& change) { return is_live(key_of(change)); });
  const bool continues = !failure_ && live && continue_with(changed, overrides);
  if (!continues) begin_anew(start_scene(std::move(changed)));
  source_ = std::move(source);
  return continues;
}

/// A simulator refuses what it cannot take over: then the changed scene begins anew.
bool LiveRun::continue_with(const PreparedScene& changed, const std::vector<std::string>& overrides) try {
  Simulator& simulator = loaded_.simulator;
  const BuiltScene& built = changed.built;
  const auto all_change = [&](const auto& names) {
    return std::ranges::all_of(overrides, [&](const std::string& change) { return names(names_of(key_of(change))); });
  };
  if (all_change([](const auto& names) { return names[0] == "gravity"; })) {
    simulator.set_gravity(built.settings.gravity);
  } else if (all_change([](const auto& names) {
               return names[0] == "air" && names.size() > 1 && is_one_of(names[1], {"wind", "gusts"});
             })) {
    simulator.set_air(built.settings.air_drag, built.settings.wind);
  } else if (!all_change([](const auto& names) { return names[0] == "obstacles"; })) {
    const bool steps_change = std::ranges::any_of(overrides, [](const std::string& change) { return key_of(change) == "step"; });
    if (steps_change) {
      drop(false);  // the force of the hand is stable for the step that it was made for
      finish_frame();
      recording_.forget_states();
    }
    simulator.continue_with(built.network, steps_change ? built.settings : with_steps_of(simulator.settings(), built.settings));
  }
  for (std::size_t k = 0; k < built.obstacles.size(); ++k) {
    if (built.obstacles[k].material != simulator.obstacles()[k].material) {
      simulator.set_obstacle_material(k, built.obstacles[k].material);
    }
  }
  loaded_.scene = changed.scene;
  loaded_.largest_stable_step = built.largest_stable_step;
  loaded_.warnings = built.warnings;
  for (const std::string& warning : simulator.warnings()) {
    if (std::ranges::find(loaded_.warnings, warning) == loaded_.warnings.end()) loaded_.warnings.push_back(warning);
  }
  return true;
} catch (const InputError&) {
  return false;
}

/// The length of a step may change at the end of a frame alone.
void LiveRun::finish_frame() {
  while (!failure_ && simulator().state().step_in_frame != 0) step();
}

void LiveRun::begin_anew(LoadedScene loaded) {
  if (!have_same_bodies(loaded.simulator.network(), simulator().network())) {
    hand_ = {};
  }
  loaded_ = std::move(loaded);
  failure_.reset();
  pull_.reset();
  pulled_ = kNone;
  infeasible_ = 0;
  loaded_.simulator.stop_when(stops_);
  restore_pins();
  recording_.begin(simulator(), hand_);
}

/// A pin that the changed scene cannot do without stays.
void LiveRun::restore_pins() {
  for (const Index i : hand_.pinned) loaded_.simulator.pin(i);
  std::erase_if(hand_.released, [&](Index i) {
    try {
      loaded_.simulator.release(i);
      return false;
    } catch (const InputError&) {
      return true;
    }
  });
}

void LiveRun::keep_pins(const LiveRun& other) {
  if (!have_same_bodies(simulator().network(), other.simulator().network())) return;
  hand_ = other.hand_;
  restore_pins();
  recording_.begin(simulator(), hand_);
}

void LiveRun::reset() { begin_anew(start_scene(prepare(source_))); }

void LiveRun::step() {
  if (failure_) return;
  const auto begin = std::chrono::steady_clock::now();
  try {
    Simulator& simulator = loaded_.simulator;
    if (simulator.state().step_in_frame == 0) simulator.reset_forces();
    const StepReport report = simulator.step();
    infeasible_ = report.infeasible;
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;
    recording_.add_step(simulator, report, elapsed.count(), hand_);
  } catch (const StepError& error) {
    failure_ = error.failure();
  }
}

bool LiveRun::go_back(double time) {
  std::optional<LiveRecording::Past> past = recording_.state_near(time);
  if (!past) return false;
  const std::optional<StepFailure> failure = std::exchange(failure_, std::nullopt);
  drop(false);
  past->state.added_forces = 0;  // the pull has ended
  try {
    loaded_.simulator.restore(past->state);
  } catch (const InputError&) {
    failure_ = failure;
    throw;
  }
  recording_.cut_after(past->state.frame);
  hand_ = std::move(past->pins);
  infeasible_ = 0;
  return true;
}

void LiveRun::stop_when(std::function<bool()> stops) {
  stops_ = std::move(stops);
  loaded_.simulator.stop_when(stops_);
}

bool LiveRun::may_change(Index particle) const {
  return !failure_ && particle >= 0 && particle < simulator().network().particle_count();
}

void LiveRun::grab(Index particle) {
  if (!may_change(particle) || simulator().state().activity.is_pinned(particle)) return;
  loaded_.simulator.wake();  // a particle that sleeps has no inverse mass
  drop(false);
  Simulator& simulator = loaded_.simulator;
  pull_ = std::make_shared<PullForce>(simulator.network(), simulator.positions(), particle, simulator.settings().step);
  pulled_ = particle;
  simulator.add_force(pull_);
}

void LiveRun::drag(const Vector3& target) {
  if (pull_ && target.allFinite()) pull_->set_target(target);
}

void LiveRun::drop(bool pin) {
  const std::shared_ptr<PullForce> pull = std::exchange(pull_, nullptr);
  if (!pull || failure_) return;
  loaded_.simulator.remove_force(*pull);
  if (!pin) return;
  loaded_.simulator.pin(pulled_);
  hand_.pinned.insert(pulled_);
  hand_.released.erase(pulled_);
}

void LiveRun::release(Index particle) {
  if (!may_change(particle)) return;
  loaded_.simulator.release(particle);
  if (hand_.pinned.erase(particle) == 0) hand_.released.insert(particle);
}

Topology LiveRun::topology() const { return topology_of(simulator()); }

FrameState LiveRun::state() const { return state_of(simulator()); }

FrameNumbers LiveRun::numbers() const {
  FrameNumbers numbers = numbers_of(simulator());
  numbers.infeasible = infeasible_;
  numbers.pull = pull_ ? pull_->total(simulator().positions(), simulator().state().v).norm() : 0.0;
  return numbers;
}

std::uint32_t LiveRun::frame() const { return 1 + static_cast<std::uint32_t>(simulator().state().frame); }

}  // namespace sprung
