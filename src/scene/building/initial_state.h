// The start of a scene that begins as another run ended.
#pragma once

#include "base/error.h"
#include "scene/building/scene_builder.h"

#include <vector>

namespace sprung {

/// Sets the start and adds warnings to a scene that was built otherwise. Reads the folder of a run, or a file that
/// Simulator::save() wrote. Adds a problem for each difference between the bodies of the two. Throws FileError or InputError if the
/// run cannot be read.
void begin_as_run_ended(const Scene& scene, BuiltScene& built, std::vector<Problem>& problems);

}  // namespace sprung
