// Problems of the text of a scene, which are reported together with those of its meshes, shapes and pins.
#pragma once

#include "base/error.h"

#include <string>
#include <vector>

namespace sprung {

struct TextProblems {
  std::vector<Problem> all;
  bool only_unknown_keys = true;  ///< whether the text is valid except for unknown keys

  /// Whether the scene may contain defaults at this key, because its text is invalid there.
  [[nodiscard]] bool affect(const std::string& key) const;
};

}  // namespace sprung
