// Simulators in files: a checkpoint, and the scene that it belongs to.
#pragma once

#include "python/simulator/scripted_simulator.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace sprung::python {

/// Writes a checkpoint with the scene and the changes of the simulator.
void save(ScriptedSimulator& simulator, const std::filesystem::path& file);

/// Continues a simulator of the same scene from a checkpoint.
void load_state(ScriptedSimulator& simulator, const std::filesystem::path& file);

/// A simulator as save() wrote it. `forces` are the functions that it had added, in order; `mesh_paths` are further folders of
/// meshes. Throws InputError if a mesh or a function is missing or another one, or if the simulator had no scene.
[[nodiscard]] Shared restore(const std::filesystem::path& file, const std::vector<pybind11::function>& forces,
                             const std::vector<std::filesystem::path>& mesh_paths);

}  // namespace sprung::python
