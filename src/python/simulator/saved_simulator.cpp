#include "python/simulator/saved_simulator.h"

#include "base/format.h"
#include "output/run_checkpoint.h"
#include "python/simulator/arrays.h"
#include "python/simulator/changes.h"
#include "python/simulator/errors.h"
#include "python/simulator/interpreter.h"
#include "simulation/checkpoint.h"
#include "simulation/model.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <map>
#include <utility>

namespace py = pybind11;

namespace sprung::python {
namespace {

const std::string kKind = "sprung.python.1\n";  // before the JSON text in a checkpoint

py::module_ json() { return py::module_::import("json"); }

std::string scene_of(ScriptedSimulator& simulator) {
  py::dict saved;
  if (const auto& origin = simulator.origin()) {
    saved["file"] = origin->source.file;
    saved["text"] = *origin->source.text;
    saved["overrides"] = origin->source.overrides;
    saved["mesh_paths"] = origin->source.mesh_paths;
    saved["fingerprints"] = fingerprints_of(*origin->model);
  }
  py::list bodies;
  for (const auto& added : simulator.added_forces()) bodies.append(added.body);
  saved["forces"] = bodies;
  saved["changes"] = simulator.changes();
  return kKind + json().attr("dumps")(saved).cast<std::string>();
}

/// Throws InputError that names each mesh that is another one than when the simulator was saved.
void expect_same_meshes(const py::dict& saved, const Model& model) {
  const auto before = saved["fingerprints"].cast<std::map<std::string, std::uint64_t>>();
  std::vector<Problem> problems;
  for (const auto& [name, fingerprint] : fingerprints_of(model)) {
    if (before.at(name) == fingerprint) continue;
    problems.push_back({.file = saved["file"].cast<std::string>(),
                        .key = name,
                        .rule = "its mesh, or the state in \"initial_state\", is another one than when the simulator was saved",
                        .remedy = "put the former file back, or load the scene and begin anew"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

/// Adds the functions, each to the body of the one that it stands for.
void add_forces(const Shared& simulator, const std::vector<py::function>& forces, const std::vector<std::string>& bodies) {
  if (forces.size() != bodies.size()) {
    refuse("forces", counted(forces.size(), "function"),
           "must be the functions that the simulator had added, of which there were " + std::to_string(bodies.size()),
           "give them in the same order: restore(path, forces=[...])");
  }
  for (std::size_t k = 0; k < forces.size(); ++k) {
    add_force(simulator, forces[k], bodies[k].empty() ? py::object(py::none()) : py::str(bodies[k]));
  }
}

}  // namespace

void save(ScriptedSimulator& simulator, const std::filesystem::path& file) {
  Checkpoint checkpoint = simulator.read().checkpoint();
  checkpoint.run = scene_of(simulator);
  const WithoutLock without_lock;
  write_checkpoint(file, checkpoint);
}

void load_state(ScriptedSimulator& simulator, const std::filesystem::path& file) {
  const Checkpoint checkpoint = read_checkpoint(file);
  simulator.change([&](Simulator& changed) { changed.restore(checkpoint); });
}

Shared restore(const std::filesystem::path& file, const std::vector<py::function>& forces,
               const std::vector<std::filesystem::path>& mesh_paths) {
  const Checkpoint checkpoint = read_checkpoint(file);
  if (!checkpoint.run.starts_with(kKind)) {
    throw InputError({.file = file.string(),
                      .rule = "was not written by Simulator.save() of Python, so it has no scene",
                      .remedy = "load the scene, make a simulator, and call its load(path)"});
  }
  const auto saved = json().attr("loads")(checkpoint.run.substr(kKind.size())).cast<py::dict>();
  if (!saved.contains("text")) {
    throw InputError({.file = file.string(),
                      .rule = "is of a simulator that was made of a Network, which the file does not hold",
                      .remedy = "make the network and its simulator again, and call load(path) of the simulator"});
  }
  SceneSource source{.file = saved["file"].cast<std::string>(),
                     .overrides = saved["overrides"].cast<std::vector<std::string>>(),
                     .mesh_paths = saved["mesh_paths"].cast<std::vector<std::string>>(),
                     .text = saved["text"].cast<std::string>()};
  for (const std::filesystem::path& folder : mesh_paths) source.mesh_paths.push_back(folder.string());
  LoadedScene loaded = load_in_python(source);
  expect_same_meshes(saved, *loaded.simulator.model());
  const auto origin = origin_of(std::move(source), loaded);
  auto restored = std::make_shared<ScriptedSimulator>(std::move(loaded.simulator), origin);
  for (const auto& [what, value] : saved["changes"].cast<std::map<std::string, std::string>>())
    repeat_change(restored, what, value);
  add_forces(restored, forces, saved["forces"].cast<std::vector<std::string>>());
  restored->change([&](Simulator& changed) { changed.restore(checkpoint); });
  return restored;
}

}  // namespace sprung::python
