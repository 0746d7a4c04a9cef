#include "base/format.h"
#include "python/bindings.h"
#include "python/simulator/arrays.h"
#include "python/simulator/errors.h"
#include "python/simulator/saved_simulator.h"
#include "python/simulator/scene_origin.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <utility>

namespace py = pybind11;

namespace sprung::python {
namespace {

/// A scene that was loaded: its simulator at time 0, of which each simulator is a copy.
struct LoadedOrigin {
  std::shared_ptr<ScriptedSimulator> first;
  std::string resolved;
  int frames = 1;
  double frame_rate = 30.0;
  double largest_stable_step = 0.0;
  std::vector<std::string> warnings;
};

std::string json_of(const py::object& value, const std::string& key) {
  try {
    py::dict options;
    options["allow_nan"] = false;
    options["default"] = py::module_::import("sprung._scene").attr("plain");
    return py::module_::import("json").attr("dumps")(value, **options).cast<std::string>();
  } catch (const py::error_already_set& error) {
    refuse(key, type_name(value), "must be what JSON can hold: " + py::str(error.value()).cast<std::string>(),
           "use dicts with texts as keys, lists, texts, finite numbers, booleans and None");
  }
}

LoadedOrigin load(const py::object& scene, const py::object& overrides, const std::vector<std::filesystem::path>& mesh_paths) {
  SceneSource source;
  if (py::isinstance<py::dict>(scene)) {
    source.file = "<dict>";
    source.text = json_of(scene, "scene");
  } else {
    source.file = py::module_::import("os").attr("fspath")(scene).cast<std::string>();
  }
  if (!overrides.is_none()) {
    for (const auto& [key, value] : overrides.cast<py::dict>()) {
      const auto name = py::str(key).cast<std::string>();
      source.overrides.push_back(name + "=" + json_of(py::reinterpret_borrow<py::object>(value), name));
    }
  }
  for (const std::filesystem::path& folder : mesh_paths) source.mesh_paths.push_back(folder.string());
  source.text = scene_text(source);  // read once
  LoadedScene loaded = load_in_python(source);
  const auto origin = origin_of(std::move(source), loaded);
  return {.first = std::make_shared<ScriptedSimulator>(std::move(loaded.simulator), origin),
          .resolved = loaded.scene.resolved,
          .frames = loaded.frames,
          .frame_rate = loaded.scene.frame_rate,
          .largest_stable_step = loaded.largest_stable_step,
          .warnings = std::move(loaded.warnings)};
}

}  // namespace

void bind_scene(py::module_& module) {
  py::class_<LoadedOrigin>(module, "Scene", "A scene that was read and built, made by sprung.load().")
      .def("__repr__",
           [](const LoadedOrigin& scene) {
             return "<sprung.Scene of " + counted(static_cast<std::size_t>(scene.frames), "frame") + ": " +
                    py::repr(py::cast(scene.first)).cast<std::string>() + ">";
           })
      .def(
          "simulator", [](const LoadedOrigin& scene) { return scene.first->copy(); },
          "simulator(self)\n--\n\nA new simulator at time 0. All simulators of a scene share the model.")
      .def_readonly("frames", &LoadedOrigin::frames, "Number of frames in the duration of the scene; the first is at time 0.")
      .def_readonly("frame_rate", &LoadedOrigin::frame_rate, "Frames per second [1/s].")
      .def_readonly("largest_stable_step", &LoadedOrigin::largest_stable_step, "[s]; infinity without a bound.")
      .def_readonly("warnings", &LoadedOrigin::warnings, "What load() warned of, a list of texts.")
      .def(
          "dict", [](const LoadedOrigin& scene) { return py::module_::import("json").attr("loads")(scene.resolved); },
          "dict(self)\n--\n\nThe scene with overrides applied and defaults filled in, as a dict.");

  module.def("load", &load, py::arg("scene"), py::kw_only(), py::arg("overrides") = py::none(),
             py::arg("mesh_paths") = std::vector<std::filesystem::path>());
  module.def("restore", &restore, py::arg("path"), py::kw_only(), py::arg("forces") = std::vector<py::function>(),
             py::arg("mesh_paths") = std::vector<std::filesystem::path>(), R"(restore(path, *, forces=(), mesh_paths=())
--

A simulator as Simulator.save(path) wrote it, which continues bit by bit. The file has the scene, but neither its meshes nor
functions. Meshes must be where they were, or in one of the folders mesh_paths. forces: the functions that the simulator had
added with add_force(), in order; each acts on the body that it acted on.

Raises FileError if this is no such file, and InputError if a mesh is missing or has changed, if forces are missing, or if the
simulator was made of a Network: then make the network again, and call Simulator.load(path).)");
}

}  // namespace sprung::python
