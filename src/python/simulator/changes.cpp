#include "python/simulator/changes.h"

#include "base/format.h"
#include "python/simulator/arrays.h"
#include "python/simulator/errors.h"
#include "python/simulator/python_force.h"
#include "simulation/model.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace sprung::python {
namespace {

const std::string kGravity = "gravity";
const std::string kSprings = "springs.";  // before the name of the body

/// Remembers a change for files.
void record(ScriptedSimulator& simulator, const std::string& what, const py::object& value) {
  simulator.changes()[what] = py::module_::import("json").attr("dumps")(value).cast<std::string>();
}

/// Of the springs of the model, those of the body that are left, of this kind.
std::vector<std::size_t> springs_left(const Simulator& simulator, const Body& body, const std::optional<SpringKind>& kind) {
  std::vector<std::size_t> left;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    const bool is_wanted = !kind || simulator.model()->network().springs.kind[s] == *kind;
    if (is_wanted && !simulator.state().springs.is_broken(s)) left.push_back(static_cast<std::size_t>(s));
  }
  return left;
}

std::optional<SpringKind> kind_of(const py::object& name, const std::string& key) {
  if (name.is_none()) return std::nullopt;
  const auto text = py::str(name).cast<std::string>();
  const auto found = std::ranges::find(kSpringKindNames, text);
  if (found == kSpringKindNames.end()) refuse(key + ".kind", text, "must be structural, shear or bend", "leave it out for all");
  return static_cast<SpringKind>(found - kSpringKindNames.begin());
}

void write_springs(const std::string& key, const py::object& value, const std::vector<std::size_t>& springs,
                   std::vector<double>& numbers) {
  if (value.is_none()) return;
  const std::vector<double> wanted = numbers_of(value, key, static_cast<Index>(springs.size()));
  for (std::size_t k = 0; k < springs.size(); ++k) {
    if (!(wanted[k] >= 0.0) || !std::isfinite(wanted[k])) {
      refuse(key + "[" + std::to_string(k) + "]", format_number(wanted[k]), "must be finite and not negative", "give 0 for none");
    }
    numbers[springs[k]] = wanted[k];
  }
}

std::vector<double> of_body(const std::vector<double>& numbers, const Body& body) {
  const auto begin = numbers.begin() + body.first_spring;
  return {begin, begin + body.spring_count};
}

/// `edit(changed, body, springs)` changes the springs of the model. They are recorded as a whole: which of them a program named
/// depends on those that broke before.
template <class Edit>
void change_springs(const Shared& simulator, const std::string& name, const Edit& edit) {
  py::dict after;
  simulator->change([&](Simulator& changed) {
    SpringNetwork network = changed.model()->network();
    const auto body = std::ranges::find(network.bodies, name, &Body::name);
    if (body == network.bodies.end()) refuse("bodies." + name, "", "is no body of the simulator", "see simulator.bodies");
    edit(changed, *body, network.springs);
    after["stiffness"] = of_body(network.springs.stiffness, *body);
    after["damping"] = of_body(network.springs.damping, *body);
    changed.continue_with(std::move(network), changed.settings());
  });
  record(*simulator, kSprings + name, after);
}

}  // namespace

void set_gravity(ScriptedSimulator& simulator, const py::object& value) {
  const Vector3 gravity = vector_of(value, "gravity");
  simulator.change([&](Simulator& changed) { changed.set_gravity(gravity); });
  record(simulator, kGravity, py::cast(std::vector<double>(gravity.begin(), gravity.end())));
}

void set_springs(const Shared& simulator, std::string body, const py::object& stiffness, const py::object& damping,
                 const py::object& kind) {
  change_springs(simulator, body, [&](const Simulator& changed, const Body& its, Springs& all) {
    const std::string key = "bodies." + body + ".springs";
    const std::vector<std::size_t> springs = springs_left(changed, its, kind_of(kind, key));
    if (springs.empty()) refuse(key, "", "has no springs of this kind", "build the body with some");
    write_springs(key + ".stiffness", stiffness, springs, all.stiffness);
    write_springs(key + ".damping", damping, springs, all.damping);
  });
}

void repeat_change(const Shared& simulator, const std::string& what, const std::string& value) {
  const py::object saved = py::module_::import("json").attr("loads")(value);
  if (what == kGravity) return set_gravity(*simulator, saved);
  change_springs(simulator, what.substr(kSprings.size()), [&](const Simulator& /*changed*/, const Body& its, Springs& all) {
    std::ranges::copy(saved["stiffness"].cast<std::vector<double>>(), all.stiffness.begin() + its.first_spring);
    std::ranges::copy(saved["damping"].cast<std::vector<double>>(), all.damping.begin() + its.first_spring);
  });
}

void add_force(const Shared& simulator, const py::function& function, const py::object& body) {
  const SpringNetwork& network = simulator->peek().network();
  PythonForce::Range range{.first = 0, .count = network.particle_count()};
  std::string name;
  if (!body.is_none()) {
    name = py::str(body).cast<std::string>();
    const auto its = std::ranges::find(network.bodies, name, &Body::name);
    if (its == network.bodies.end()) refuse("bodies." + name, "", "is no body of the simulator", "see simulator.bodies");
    range = {.first = its->first_particle, .count = its->particle_count};
  }
  const auto force = std::make_shared<PythonForce>(function, range, body.is_none());
  simulator->change([&](Simulator& changed) { changed.add_force(force); });
  simulator->added_forces().push_back({force, function, name});
}

void remove_force(ScriptedSimulator& simulator, const py::object& function) {
  auto& added = simulator.added_forces();
  const auto found = std::ranges::find_if(added, [&](const auto& each) { return each.function.equal(function); });
  if (found == added.end()) {
    refuse("added force", py::str(function).cast<std::string>(), "was not added", "give the function that was");
  }
  simulator.change([&](Simulator& changed) { changed.remove_force(*found->force); });
  added.erase(found);
}

}  // namespace sprung::python
