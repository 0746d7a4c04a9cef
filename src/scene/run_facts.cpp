#include "scene/run_facts.h"

#include "scene/building/strength_scatter.h"
#include "scene/load_scene.h"

#include <optional>
#include <utility>

namespace sprung {

RunFacts facts_of(const LoadedScene& loaded) {
  BodyMaterials materials;
  for (const BodyScene& body : loaded.scene.bodies) {
    if (!body.preset.empty()) materials[body.name] = body.preset;
  }
  return {.scene = loaded.scene.resolved,
          .frame_rate = loaded.scene.frame_rate,
          .frames = loaded.frames,
          .steps_per_frame = loaded.simulator.settings().steps_per_frame,
          .stretch_solver = loaded.simulator.stretch_solver(),
          .seed = uses_seed(loaded.scene) ? std::optional(loaded.scene.settings.seed) : std::nullopt,
          .adjustments = loaded.adjustments,
          .warnings = loaded.warnings,
          .sources = loaded.sources,
          .scene_file = loaded.scene.file.filename().string(),
          .materials = std::move(materials),
          .formats = {}};
}

}  // namespace sprung
