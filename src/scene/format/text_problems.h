// What is wrong with the text of a scene, so that what only its meshes, shapes and pins show can be told beside it.
#pragma once

#include "base/error.h"

#include <string>
#include <vector>

namespace sprung {

struct TextProblems {
  std::vector<Problem> all;
  bool only_unknown_keys = true;  ///< everything else is as the user wants it

  /// Whether the scene may hold defaults under this key instead of what the user wants.
  [[nodiscard]] bool spoil(const std::string& key) const;
};

}  // namespace sprung
