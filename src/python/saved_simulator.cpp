#include "python/saved_simulator.h"

#include "python/arrays.h"
#include "python/errors.h"
#include "python/parts.h"
#include "python/python_force.h"
#include "scene/load_scene.h"
#include "simulation/checkpoint.h"
#include "simulation/model.h"

#include <algorithm>
#include <utility>

#include <pybind11/stl.h>

namespace py = pybind11;

namespace sprung::python {
namespace {

const std::string kKind = "sprung.python.1\n";  // before the JSON text in a checkpoint

py::module_ json() { return py::module_::import("json"); }

std::string scene_of(ScriptedSimulator& simulator) {
  py::dict saved;
  if (const auto& origin = simulator.origin()) {
    saved["file"] = std::filesystem::absolute(origin->file).string();
    saved["text"] = origin->text;
    saved["overrides"] = origin->overrides;
    std::vector<std::string> folders;
    for (const std::string& folder : origin->mesh_paths) folders.push_back(std::filesystem::absolute(folder).string());
    saved["mesh_paths"] = folders;
  }
  saved["changes"] = simulator.changes();
  return kKind + json().attr("dumps")(saved).cast<std::string>();
}

void repeat_change(const std::shared_ptr<ScriptedSimulator>& simulator, const std::string& text) {
  const auto change = json().attr("loads")(text).cast<py::dict>();
  if (change["do"].cast<std::string>() == "set_gravity") {
    const Vector3 gravity = vector_of(change["gravity"], "gravity");
    simulator->change([&](Simulator& changed) { changed.set_gravity(gravity); });
    simulator->changes().push_back(text);
  } else {
    set_springs(simulator, change["body"].cast<std::string>(), change["stiffness"], change["damping"], change["kind"]);
  }
}

}  // namespace

void save(ScriptedSimulator& simulator, const std::filesystem::path& file) {
  Checkpoint checkpoint = simulator.read().checkpoint();
  checkpoint.run = scene_of(simulator);
  const py::gil_scoped_release release;
  write_checkpoint(file, checkpoint);
}

void load_state(ScriptedSimulator& simulator, const std::filesystem::path& file) {
  const Checkpoint checkpoint = read_checkpoint(file);
  simulator.change([&](Simulator& changed) { changed.restore(checkpoint); });
}

std::shared_ptr<ScriptedSimulator> restore(const std::filesystem::path& file, const std::vector<py::function>& forces) {
  const Checkpoint checkpoint = read_checkpoint(file);
  if (!checkpoint.run.starts_with(kKind)) {
    refuse(file.string(), "", "was not written by Simulator.save() of Python, so it has no scene",
           "load the scene, make a simulator, and call its load(path)");
  }
  const auto saved = json().attr("loads")(checkpoint.run.substr(kKind.size())).cast<py::dict>();
  if (!saved.contains("text")) {
    refuse(file.string(), "", "is of a simulator that was made without a scene",
           "make the network again, and call load(path) of its simulator");
  }
  SceneOrigin origin{.file = saved["file"].cast<std::string>(),
                     .text = saved["text"].cast<std::string>(),
                     .overrides = saved["overrides"].cast<std::vector<std::string>>(),
                     .mesh_paths = saved["mesh_paths"].cast<std::vector<std::string>>(),
                     .sources = {}};
  LoadedScene loaded =
      load_scene({.file = origin.file, .overrides = origin.overrides, .mesh_paths = origin.mesh_paths, .text = origin.text});
  origin.sources = loaded.sources;
  auto restored =
      std::make_shared<ScriptedSimulator>(std::move(loaded.simulator), std::make_shared<const SceneOrigin>(std::move(origin)));
  for (const std::string& change : saved["changes"].cast<std::vector<std::string>>()) repeat_change(restored, change);
  for (const py::function& function : forces) add_force(restored, function, py::none());
  restored->change([&](Simulator& changed) { changed.restore(checkpoint); });
  return restored;
}

void add_force(const std::shared_ptr<ScriptedSimulator>& simulator, const py::function& function, const py::object& body) {
  const SpringNetwork& network = simulator->peek().network();
  PythonForce::Range range{.first = 0, .count = network.particle_count()};
  if (!body.is_none()) {
    const auto name = py::str(body).cast<std::string>();
    const auto its = std::ranges::find(network.bodies, name, &Body::name);
    if (its == network.bodies.end()) refuse("bodies." + name, "", "is no body of the simulator", "see simulator.bodies");
    range = {.first = its->first_particle, .count = its->particle_count};
  }
  const auto force = std::make_shared<PythonForce>(function, range, body.is_none());
  simulator->change([&](Simulator& changed) { changed.add_force(force); });
  simulator->added_forces().push_back({force, function});
}

}  // namespace sprung::python
