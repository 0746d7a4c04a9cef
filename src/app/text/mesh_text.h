// Text that describes a mesh.
#pragma once

#include "geometry/import/mesh_import.h"

#include <string>
#include <vector>

namespace sprung {

/// `1.2 x 0.8 x 3 m`
[[nodiscard]] std::string describe_size(const Box3& box);

/// `closed`, or `open: 12 border edges, 0 edges with more than two faces`
[[nodiscard]] std::string describe_closedness(const MeshReport& report);

/// The repairs by the import, for example `3 faces flipped`; empty if there were none. Welding is not a repair: most formats, or
/// their readers, give every face its own corners.
[[nodiscard]] std::vector<std::string> repairs(const MeshReport& report);

/// `label      text`, in columns.
[[nodiscard]] std::string text_row(const std::string& label, const std::string& text);

}  // namespace sprung
