// The `v` lines of OBJ files.
#pragma once

#include "base/types.h"

#include <string>

namespace sprung {

/// The `v` lines of positions [m], 3 x n, with the shortest numbers that read back to the same bits. The text does not depend on
/// the number of threads. Costly: it formats all positions, in parallel.
[[nodiscard]] std::string vertex_lines(const Points& vertices);

/// The positions of the `v` lines of a frame, 3 x n. Lines that are no `v` lines, or hold no three numbers, are left out.
[[nodiscard]] Points read_vertex_lines(const std::string& text);

}  // namespace sprung
