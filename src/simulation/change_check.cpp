#include "simulation/change_check.h"

#include "base/error.h"
#include "base/format.h"
#include "geometry/motion/motion_check.h"
#include "network/network_check.h"

#include <algorithm>
#include <array>
#include <cmath>

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

// Pins and attachments of a network that no NetworkBuilder made: their particles, and names that pins of the program have.
void check_ends(const SpringNetwork& network, const std::vector<Pin>& added_pins, ProblemList& problems) {
  std::vector<Index> begins;
  for (const Body& body : network.bodies) begins.push_back(body.first_particle);
  check_pins(network.pins, network.particle_count(), problems);
  check_attachments(network.attachments, network.particle_count(), begins, problems);
  for (const Pin& added : added_pins) {
    const auto is_its = [&](const auto& named) { return named.name == added.name; };
    if (std::ranges::none_of(network.pins, is_its) && std::ranges::none_of(network.attachments, is_its)) continue;
    problems.add("pins." + added.name, "", "is the name of a pin that the program added",
                 "choose another name, or change the network of model(), which has no added pins");
  }
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

std::string key_of(const Force& force) { return "added force \"" + force.name() + "\""; }
std::string key_of(const Constraint& /*constraint*/) { return "added constraint"; }

template <class Added>
void require_new(const std::string& key, const std::shared_ptr<Added>& added, const std::vector<std::shared_ptr<Added>>& others) {
  if (added == nullptr)
    throw InputError({.key = key, .value = "null", .rule = "must be an object", .remedy = "make one with std::make_shared"});
  if (std::ranges::find(others, added) == others.end()) return;
  throw InputError({.key = key_of(*added), .rule = "was added already", .remedy = "change its parameters, or make another object"});
}

void require_particles(const std::string& key, const std::vector<Index>& particles, const SpringNetwork& network,
                       ProblemList& problems) {
  problems.require_each(
      particles.size(), [&](std::size_t k) { return particles[k] >= 0 && particles[k] < network.particle_count(); },
      [&](std::size_t k) { return std::to_string(particles[k]); },
      {key, "must be the number of a particle; there are " + std::to_string(network.particle_count()), "count particles from 0"});
}

void require_particles(const std::string& key, const std::vector<Index>& particles, const SpringNetwork& network) {
  ProblemList problems;
  require_particles(key, particles, network, problems);
  problems.throw_if_any();
}

}  // namespace

void check_change(const SpringNetwork& network, const SimulatorSettings& settings, const Model& before,
                  const SimulationState& state) {
  const std::string restart = "begin a new run";
  ProblemList problems;
  if (!have_same_bodies(network, before.network())) {
    problems.add("bodies", "", "must have the same names and particles as before, as the run goes on", restart);
  } else if (!collide_alike(network, before.network())) {
    problems.add("contact", "", "must be enabled for the same bodies as before, as the run goes on", restart);
  }
  check_ends(network, state.steering.added_pins, problems);
  check_step_change(settings, before.settings(), state, problems);
  if (settings.contact.response != before.settings().contact.response) {
    problems.add("contact.response", "", "must stay as it is, as the run goes on", restart);
  }
  problems.throw_if_any();
}

void check_entry(const std::string& key, const std::string& what, std::int64_t number, std::int64_t count) {
  if (number >= 0 && number < count) return;
  const std::string there = count == 0 ? "are none" : (count == 1 ? "is 1" : "are " + std::to_string(count));
  throw InputError({.key = key,
                    .value = std::to_string(number),
                    .rule = "must be the number of " + what + "; there " + there,
                    .remedy = "count " + key + " from 0"});
}

void check_number(const std::string& key, double number, ProblemList& problems) {
  if (std::isfinite(number) && number >= 0.0) return;
  problems.add(key, format_number(number, 6), "must be finite and not negative", "give 0 for none");
}

void check_move(const std::string& key, const RigidTransform& from, const RigidTransform& to, double reach,
                const SpringNetwork& network) {
  ProblemList problems;
  check_pose(key, to, problems);
  problems.throw_if_any();
  const double distance = travel(from, to, reach);
  constexpr double kRounding = 1.0e-9;
  const double most = largest_size(network);
  if (most == 0.0 || distance <= (1.0 + kRounding) * most) return;  // bodies without extent cannot be stretched
  throw InputError({.key = key,
                    .value = format_number(distance, 6) + " m from the present pose",
                    .rule = "must be at most " + format_number(most, 6) + " m away in one step, the size of the largest body",
                    .remedy = "go there in " + format_number(std::ceil(distance / most - kRounding)) + " steps"});
}

void check_motion(const SpringNetwork& network, const SimulationState& state, const Points& positions, const Points& velocities) {
  ProblemList problems;
  const auto count = static_cast<Eigen::Index>(network.particle_count());
  for (const auto& [key, points] : {std::pair("positions", &positions), {"velocities", &velocities}}) {
    if (points->cols() == count) continue;
    problems.add(key, counted(static_cast<std::size_t>(points->cols()), "column"), "must have one for each particle",
                 "give " + std::to_string(count));
  }
  problems.throw_if_any();
  const auto require = [&](const std::string& what, const Points& points, const auto& is_good, const std::string& rule,
                           const std::string& remedy) {
    for (const Body& body : network.bodies) {
      problems.require_each(
          static_cast<std::size_t>(body.particle_count),
          [&](std::size_t k) { return is_good(body.first_particle + static_cast<Index>(k)); },
          [&](std::size_t k) { return vector_text(points.col(body.first_particle + static_cast<Index>(k)), 6); },
          {"bodies." + body.name + "." + what, rule, remedy});
    }
  };
  require(
      "particles", positions, [&](Index i) { return positions.col(i).allFinite(); }, "must be finite", "write finite positions");
  require(
      "velocities", velocities, [&](Index i) { return velocities.col(i).allFinite(); }, "must be finite",
      "write finite velocities");
  require(
      "particles", positions,
      [&](Index i) { return !network.is_pinned(i) || !positions.col(i).allFinite() || positions.col(i) == state.x.col(i); },
      "is pinned and must stay where it is", "move its pin, or release it first");
  problems.throw_if_any();
}

void check_particle(const SpringNetwork& network, Index particle) {
  check_entry("particles", "a particle", particle, network.particle_count());
}

void check_added(const std::shared_ptr<Force>& force, const Control& control, const SpringNetwork& network) {
  require_new("added force", force, control.forces);
  std::vector<LinearElement> elements;
  force->append_elements(elements);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const LinearElement& element = elements[e];
    const auto used = std::min(element.count, element.particles.size());
    const std::string key = entry_key(key_of(*force) + ".append_elements()", e);
    require_particles(key + ".particles", {element.particles.begin(), element.particles.begin() + used}, network);
    const bool finite =
        std::all_of(element.weights.begin(), element.weights.begin() + used, [](double w) { return std::isfinite(w); }) &&
        std::isfinite(element.stiffness) && std::isfinite(element.damping);
    if (!finite) {
      throw InputError(
          {.key = key, .rule = "must have finite weights, stiffness and damping", .remedy = "correct append_elements()"});
    }
  }
}

void check_added(const std::shared_ptr<Constraint>& constraint, const Control& control, const SpringNetwork& /*network*/) {
  require_new("added constraint", constraint, control.constraints);
}

TouchedParticles checked_touched(const Control& control, const SpringNetwork& network) {
  TouchedParticles touched;
  const auto ask = [&](const auto& added) {
    const std::optional<std::vector<Index>> its = added.touched();
    touched.any = touched.any || !its;
    if (!its) return;
    require_particles(key_of(added) + ".touched()", *its, network);
    touched.particles.insert(touched.particles.end(), its->begin(), its->end());
  };
  for (const auto& force : control.forces) ask(*force);
  for (const auto& constraint : control.constraints) ask(*constraint);
  return touched;
}

bool is_free_for(Index particle, const std::string& name, const Model& model, const SimulationState& state) {
  const auto is_its = [&](const auto& named) { return named.name == name; };
  const auto holds_others = [&](const Pin& pin) { return pin.name == name && pin.particles != std::vector<Index>{particle}; };
  return std::ranges::none_of(model.network().pins, is_its) && std::ranges::none_of(model.network().attachments, is_its) &&
         std::ranges::none_of(state.steering.added_pins, holds_others);
}

void check_pin(const SpringNetwork& model, const std::vector<Index>& particles, const std::string& name) {
  const std::string key = "pins." + name;
  ProblemList problems;
  if (particles.empty()) problems.add(key, "", "must contain at least one particle", "name a particle");
  require_particles(key, particles, model, problems);
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

}  // namespace sprung
