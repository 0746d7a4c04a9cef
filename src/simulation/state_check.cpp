#include "base/format.h"
#include "geometry/motion/motion_check.h"
#include "simulation/change_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace sprung {
namespace {

constexpr std::int64_t kMostSteps = std::int64_t{1} << 53;  // larger numbers are not exact as a double

const char* const kRemedy = "give the state of a simulator of the same scene";

class StateRules {
 public:
  StateRules(const StateOwner& owner, const SimulationState& state) : owner_(owner), state_(state) {}

  void check_all() {
    require_points("x", state_.x);
    problems_.throw_if_any();  // most counts would be wrong too
    check_time();
    check_motion();
    check_activity();
    check_springs();
    check_contact();
    check_rest();
    check_grips();
    check_links();
    check_impulses();
    check_added();
    problems_.throw_if_any();
  }

 private:
  void check_time() {
    const SimulatorSettings& settings = owner_.model.settings();
    const std::int64_t steps = settings.steps_per_frame;
    require(state_.step >= 0 && state_.step <= kMostSteps, "step", state_.step, "must be from 0 to 2^53");
    require(state_.frame >= 0 && state_.frame <= kMostSteps / steps, "frame", state_.frame, "must be from 0 to 2^53 steps");
    require_setting("step_length", format_number(state_.step_length), format_number(settings.step));
    require_setting("steps_per_frame", std::to_string(state_.steps_per_frame), std::to_string(steps));
    require_setting("integrator", integrator_name(state_.integrator), integrator_name(settings.integrator.index()));
    require(state_.step_in_frame >= 0 && state_.step_in_frame < steps, "step_in_frame", state_.step_in_frame,
            "must be from 0 to one less than the steps of a frame");
    const int most = (settings.stretch_limit ? settings.max_substeps : 1) * settings.inner_substeps;
    require(state_.substeps >= 1 && state_.substeps <= most, "substeps", state_.substeps,
            "must be from 1 to " + std::to_string(most) + ", as the settings say");
    require(state_.substep == 0, "substep", state_.substep, "must be 0, as between two steps");
  }

  static std::string integrator_name(std::size_t number) {
    constexpr std::array<const char*, std::variant_size_v<IntegratorSettings>> kNames{
        "ExplicitEulerSettings",  "SymplecticEulerSettings", "VerletSettings",
        "VelocityVerletSettings", "RungeKutta4Settings",     "ImplicitEulerSettings"};
    return number < kNames.size() ? kNames[number] : std::to_string(number);
  }

  void require_setting(const std::string& key, const std::string& in_state, const std::string& in_simulator) {
    if (in_state == in_simulator) return;
    problems_.add("state." + key, in_state, "must be that of this simulator, " + in_simulator,
                  "call continue_with() with the settings of the simulator that had the state, then restore()");
  }

  void check_motion() {
    require_points("v", state_.v);
    require_points("x_previous", state_.x_previous);
    require_size("limit.handovers", state_.limit.handovers.size(), network().bodies.size(), "bodies");
    require_each("limit.handovers", state_.limit.handovers, [&](const StretchHandover& handover) {
      return handover.missed_steps >= 0 && (owner_.model.settings().stretch_limit.has_value() || handover.missed_steps == 0);
    });
    const EnergyMemory& energy = state_.energy;
    const double sum = energy.start + energy.highest_gravity + energy.stored + energy.max_kinetic + energy.fastest_drive;
    require_finite("energy", sum);
  }

  void check_activity() {
    const Activity& activity = state_.activity;
    const Steering& steering = state_.steering;
    const std::size_t pins = network().pins.size() + steering.added_pins.size();
    require_size("activity.phases", activity.phases.size(), pins, "pins");
    const bool known = std::ranges::all_of(activity.phases, [](PinPhase phase) { return phase <= PinPhase::over; });
    require(known, "activity.phases", "", "must be waiting, holding or over");
    require_size("activity.pin_of", activity.pin_of.size(), particles(), "particles");
    if (!activity.asleep.empty()) require_size("activity.asleep", activity.asleep.size(), particles(), "particles");
    require_indices("activity.pin_of", activity.pin_of,
                    [&](Index pin) { return pin == kNone || (pin >= 0 && static_cast<std::size_t>(pin) < pins); });
    for (const Pin& pin : steering.added_pins) {
      require(may_be_added(pin), "steering.added_pins", pin.name,
              "must have a name of its own, particles that exist, a finite origin and begin, and neither motion, obstacle nor end");
    }
    check_steered("steering.pins", steering.pins, pins);
    check_steered("steering.obstacles", steering.obstacles, owner_.model.obstacles().obstacles().size());
  }

  [[nodiscard]] bool may_be_added(const Pin& pin) const {
    const auto is_its = [&](const auto& named) { return named.name == pin.name; };
    return !pin.name.empty() && std::ranges::count_if(state_.steering.added_pins, is_its) == 1 &&
           std::ranges::none_of(network().pins, is_its) && std::ranges::none_of(network().attachments, is_its) &&
           std::ranges::all_of(pin.particles, [&](Index i) { return is_particle(i); }) && pin.origin.allFinite() &&
           std::isfinite(pin.from) && !pin.moves() && pin.until == std::numeric_limits<double>::infinity();
  }

  void check_steered(const std::string& key, const std::vector<SteeredMotion>& motions, std::size_t count) {
    const auto not_later = [](const TimedPose& a, const TimedPose& b) { return b.time <= a.time; };
    require_each(key, motions, [&](const SteeredMotion& motion) {
      const std::vector<TimedPose>& poses = motion.poses;
      return motion.number < count && !poses.empty() && std::ranges::adjacent_find(poses, not_later) == poses.end() &&
             std::ranges::all_of(poses, [](const TimedPose& at) { return std::isfinite(at.time) && is_rigid(at.pose); });
    });
    const auto not_higher = [](const SteeredMotion& a, const SteeredMotion& b) { return b.number <= a.number; };
    require(std::ranges::adjacent_find(motions, not_higher) == motions.end(), key, "", "must be sorted by number");
  }

  void check_springs() {
    const SpringState start = initial_springs(network().springs);
    const SpringState& springs = state_.springs;
    require_size("springs.rest_lengths", springs.rest_lengths.size(), start.rest_lengths.size(), "springs, if any yields");
    require_size("springs.broken", springs.broken.size(), start.broken.size(), "springs, if any breaks");
    if (!springs.unloading.empty()) require_size("springs.unloading", springs.unloading.size(), particles(), "particles");
    const auto is_finite = [](const Unloading& at) { return std::isfinite(at.by_all + at.by_near + at.by_recoil); };
    require(std::ranges::all_of(springs.unloading, is_finite), "springs.unloading", "", "must be finite");
    const bool valid =
        std::ranges::all_of(springs.rest_lengths, [](double length) { return std::isfinite(length) && length >= 0.0; });
    require(valid, "springs.rest_lengths", "", "must be finite and not negative");
  }

  void check_contact() {
    const ContactMemory& contact = state_.contact;
    if (owner_.can_collide) {
      require_points("contact.slip.displacement", contact.slip.displacement);
      require_size("contact.slip.obstacle", contact.slip.obstacle.size(), particles(), "particles");
    }
    require_indices("contact.slip.obstacle", contact.slip.obstacle, [&](Index k) { return k == kNone || is_obstacle(k); });
    require_indices("contact.pushed", contact.pushed, [&](Index i) { return is_particle(i); });
    require_each("contact.normals", contact.normals,
                 [&](const ContactNormal& touching) { return is_particle(touching.particle) && touching.normal.allFinite(); });
    require_each("contact.permitted_crossings", contact.permitted_crossings, [&](const PermittedCrossing& crossing) {
      return is_particle(crossing.particle) && is_obstacle(crossing.obstacle);
    });
  }

  void check_rest() {
    const RestMemory& rest = state_.rest;
    const auto groups = static_cast<std::size_t>(owner_.sleep_groups);
    require_size("rest.sleepers", rest.sleepers.size(), groups, "sleep groups");
    const std::size_t histories = rest.window_begin ? groups + network().bodies.size() : 0;
    require_size("rest.histories", rest.histories.size(), histories, "sleep groups and bodies, after the begin of a window");
    if (!rest.window_begin) return;
    require_finite("rest.window_begin", *rest.window_begin);
    require(rest.frames >= 0, "rest.frames", rest.frames, "must not be negative");
    require_points("rest.x_at_frame", rest.x_at_frame);
    for (const Points& positions : rest.x_at_begins) require_points("rest.x_at_begins", positions);
    require_points("rest.x_beside_sleep", rest.x_beside_sleep);
  }

  void check_grips() {
    require_each("grips", state_.grips, [&](const PinGrip& grip) {
      return is_particle(grip.particle) && std::isfinite(grip.time) && grip.position.allFinite();
    });
    const auto not_higher = [](const PinGrip& a, const PinGrip& b) { return b.particle <= a.particle; };
    require(std::ranges::adjacent_find(state_.grips, not_higher) == state_.grips.end(), "grips", "",
            "must be sorted by particle, one for each");
    for (std::size_t p = 0; p < network().pins.size(); ++p) {
      const Pin& pin = network().pins[p];
      if (!is_obstacle(pin.obstacle) || state_.activity.pin_of.size() != particles()) continue;
      for (const Index i : pin.particles) {
        if (state_.activity.pin_of[i] != static_cast<Index>(p)) continue;
        const auto known = std::ranges::lower_bound(state_.grips, i, {}, &PinGrip::particle);
        if (known == state_.grips.end() || known->particle != i || has_triangle(pin.obstacle, known->triangle)) continue;
        require(false, "grips." + pin.name + ".triangle", known->triangle, "must be a triangle of the obstacle");
      }
    }
  }

  void check_links() {
    require_each("links", state_.links, [&](const Link& link) { return fits(link); });
    require(std::ranges::is_sorted(state_.links, {}, &Link::attachment), "links", "", "must be sorted by attachment");
    std::set<std::pair<std::size_t, Index>> ends;
    for (const Link& link : state_.links) ends.emplace(link.attachment, link.first);
    require(ends.size() == state_.links.size(), "links", "", "must be one for each first end of an attachment");
  }

  [[nodiscard]] bool fits(const Link& link) const {
    if (link.attachment >= network().attachments.size() || !is_particle(link.first)) return false;
    if (!std::ranges::all_of(link.second, [&](Index i) { return i == kNone || is_particle(i); })) return false;
    const Attachment& attachment = network().attachments[link.attachment];
    const auto* end = std::get_if<ObstacleEnd>(&attachment.second);
    if (end != nullptr && is_obstacle(end->obstacle) && !has_triangle(end->obstacle, link.triangle)) return false;
    return link.weights.allFinite() && link.anchor.allFinite() && link.impulse.allFinite() &&
           std::isfinite(link.distance + link.length + link.time);
  }

  void check_impulses() {
    const bool fit =
        state_.impulses.on() == state_.last_impulses.on() && state_.impulses.has_contact() == state_.last_impulses.has_contact();
    require(fit, "last_impulses", "", "must be there if `impulses` are");
    const auto is_finite = [](const auto& reaction) { return reaction.second.allFinite(); };
    require(std::ranges::all_of(state_.reactions.impulses, is_finite), "reactions.impulses", "", "must be finite");
    require_finite("reactions.since", state_.reactions.since);
    for (const auto& [key, impulses] : {std::pair("impulses", &state_.impulses), {"last_impulses", &state_.last_impulses}}) {
      if (impulses->has_contact()) require_points(std::string(key) + ".of_contact", impulses->of_contact);
      if (!impulses->on()) continue;
      require_points(std::string(key) + ".on_pinned", impulses->on_pinned);
      const auto springs = static_cast<std::size_t>(network().springs.count() - state_.springs.broken_count());
      require_size(std::string(key) + ".of_springs", static_cast<std::size_t>(impulses->of_springs.size()), springs,
                   "springs that are left");
      require(impulses->of_springs.allFinite(), std::string(key) + ".of_springs", "", "must be finite");
    }
  }

  void check_added() {
    const auto require_same = [&](const std::string& key, std::size_t in_state, std::size_t in_simulator) {
      if (in_state == in_simulator) return;
      problems_.add("state." + key, std::to_string(in_state),
                    "must be " + std::to_string(in_simulator) + ", the number that this simulator has",
                    "add the same forces and constraints in the same order, then restore");
    };
    require_same("added_forces", state_.added_forces, owner_.control.forces.size());
    require_same("added_constraints", state_.added_constraints, owner_.control.constraints.size());
  }

  [[nodiscard]] const SpringNetwork& network() const { return owner_.model.network(); }
  [[nodiscard]] std::size_t particles() const { return static_cast<std::size_t>(network().particle_count()); }
  [[nodiscard]] bool is_particle(Index i) const { return i >= 0 && i < network().particle_count(); }
  [[nodiscard]] bool is_obstacle(Index k) const {
    return k >= 0 && static_cast<std::size_t>(k) < owner_.model.obstacles().obstacles().size();
  }

  /// Rigid obstacles need none.
  [[nodiscard]] bool has_triangle(Index obstacle, Index triangle) const {
    const Obstacle& shape = owner_.model.obstacles().obstacles()[static_cast<std::size_t>(obstacle)];
    if (!shape.deforms()) return true;
    return triangle >= 0 && triangle < std::get<SequenceGeometry>(shape.geometry).sequence->triangles.cols();
  }

  void add(const std::string& key, const std::string& value, const std::string& rule) {
    problems_.add("state." + key, value, rule, kRemedy);
  }
  void require(bool good, const std::string& key, const std::string& value, const std::string& rule) {
    if (!good) add(key, value, rule);
  }
  void require(bool good, const std::string& key, std::int64_t value, const std::string& rule) {
    require(good, key, std::to_string(value), rule);
  }
  void require_finite(const std::string& key, double value) {
    require(std::isfinite(value), key, format_number(value), "must be finite");
  }
  void require_size(const std::string& key, std::size_t size, std::size_t count, const std::string& what) {
    const std::string rule = "must have " + std::to_string(count) + " entries, one for each of the " + what;
    require(size == count, key, std::to_string(size) + " entries", rule);
  }
  void require_points(const std::string& key, const Points& points) {
    require_size(key, static_cast<std::size_t>(points.cols()), particles(), "particles");
    require(points.allFinite(), key, "", "must be finite");
  }
  template <class Good>
  void require_indices(const std::string& key, const std::vector<Index>& indices, const Good& good) {
    const auto text = [&](std::size_t entry) { return std::to_string(indices[entry]); };
    problems_.require_each(indices.size(), [&](std::size_t entry) { return good(indices[entry]); }, text,
                           {"state." + key, "must be the number of one of them", kRemedy});
  }
  template <class Entry, class Good>
  void require_each(const std::string& key, const std::vector<Entry>& entries, const Good& good) {
    problems_.require_each(
        entries.size(), [&](std::size_t entry) { return good(entries[entry]); },
        [](std::size_t /*entry*/) { return std::string(); },
        {"state." + key, "must have finite numbers, and name particles, pins, obstacles and attachments that exist", kRemedy});
  }

  const StateOwner& owner_;
  const SimulationState& state_;
  ProblemList problems_;
};

}  // namespace

void check_state(const StateOwner& owner, const SimulationState& state) { StateRules(owner, state).check_all(); }

}  // namespace sprung
