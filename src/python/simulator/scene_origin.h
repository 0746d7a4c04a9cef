// The scene that a simulator comes from.
#pragma once

#include "geometry/obj_source/obj_source.h"
#include "scene/load_scene.h"

#include <memory>

namespace sprung::python {

/// What is needed to load a scene again, wherever the program then runs. Never changes.
struct SceneOrigin {
  SceneSource source;                  ///< with its text; all paths are absolute
  ObjSources bodies;                   ///< the files of bodies
  std::shared_ptr<const Model> model;  ///< as it was built
};

/// Loads a scene without the interpreter's lock; one that records forces records those of contact too. Throws as load_scene(), in
/// words of Python: `mesh_paths` for `--mesh-path`.
[[nodiscard]] LoadedScene load_in_python(const SceneSource& source);

/// `source` has its text. Call it where the scene was loaded: relative paths are completed by the working directory.
[[nodiscard]] std::shared_ptr<const SceneOrigin> origin_of(SceneSource source, const LoadedScene& loaded);

}  // namespace sprung::python
