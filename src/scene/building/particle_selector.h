// The particles of a body that a selector of a scene names.
#pragma once

#include "scene/building/body_builder.h"

#include <string>
#include <vector>

namespace sprung {

/// Where a selector is written, for the report of its problems.
struct SelectorLocation {
  std::string file;
  std::string key;  ///< of the object that has it
};

/// The problem of a group that a mesh does not have, without its file and key.
[[nodiscard]] Problem unknown_group(const std::string& name, const ObjGroups& groups);

/// The selected particles, ascending, each once; counted from 0 within the body. Indices of a selector count the vertices of a
/// mesh's file, and of a lattice the corners of its cells after them; vertices that contact alone has are not selected. Adds a
/// problem if the selector names a particle or a group that does not exist, or if there is none in its box or sphere.
[[nodiscard]] std::vector<Index> select_particles(const Selector& selector, const BodyScene& body, const BuiltBody& placed,
                                                  const SelectorLocation& location, std::vector<Problem>& problems);

}  // namespace sprung
