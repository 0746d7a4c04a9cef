// The interface between kernels and the memory layouts of SpringBatches. Each layout has a group type with `find_squared`, the
// squared lengths of the springs, and `move`, which moves their ends towards each other, or apart along their earlier direction:
// see layout_runs.h, layout_gathered.h. For the .cpp files of kernels alone, as simd.h.
#pragma once

#include "base/types.h"

#include <cstddef>

namespace sprung {

/// Displacements of the ends, as fractions of the vector between them.
template <class Lanes>
struct Moves {
  Lanes first;
  Lanes second;
};

/// No displacements along the earlier direction.
struct NoPushes {};

[[gnu::always_inline]] inline std::ptrdiff_t offset_of(Index particle) { return std::ptrdiff_t{3} * particle; }

}  // namespace sprung
