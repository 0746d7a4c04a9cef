// What run.json says of a scene.
#pragma once

#include "output/run_summary.h"

namespace sprung {

struct LoadedScene;

/// The facts of a run of this scene with all its frames, with a record and no other format, without checkpoints.
[[nodiscard]] RunFacts facts_of(const LoadedScene& loaded);

}  // namespace sprung
