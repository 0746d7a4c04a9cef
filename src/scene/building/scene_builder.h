// Builds a simulation from a scene: finds and imports meshes, builds bodies and chooses the step.
#pragma once

#include "geometry/import/mesh_import.h"
#include "geometry/obj_source/obj_source.h"
#include "network/model/spring_network.h"
#include "network/step_adjustment.h"
#include "scene/format/scene.h"
#include "scene/format/text_problems.h"
#include "simulation/model.h"
#include "simulation/settings/simulator_settings.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sprung {

struct NamedReport {
  std::string obstacle;
  std::filesystem::path file;  ///< of a sequence: the first file
  std::size_t files = 1;
  MeshReport report;
};

struct BuiltScene {
  SpringNetwork network;
  std::vector<Obstacle> obstacles;
  std::filesystem::path initial_state;  ///< folder or file of the start; empty: none
  StartState start;                     ///< empty unless the scene begins as another run ended
  SimulatorSettings settings;           ///< with the chosen step
  int frames = 1;                       ///< floor(duration * frame_rate + 1e-9) + 1
  double largest_stable_step = 0.0;     ///< [s]; infinity if every step is stable
  std::vector<NamedReport> meshes;
  ObjSources sources;                                ///< the files of bodies
  std::map<std::string, std::string> weld_remedies;  ///< for bodies of a mesh whose pieces touch, by their names
  std::vector<StepAdjustment> adjustments;           ///< of bodies that were adjusted for larger steps
  std::vector<std::string> warnings;
};

/// Looks for mesh files beside the scene file, then in `mesh_paths`. Throws InputError with every problem: first the problems
/// `known` of the scene's text, then those that do not follow from them.
[[nodiscard]] BuiltScene build_scene(const Scene& scene, const std::vector<std::filesystem::path>& mesh_paths = {},
                                     const TextProblems& known = {});

}  // namespace sprung
