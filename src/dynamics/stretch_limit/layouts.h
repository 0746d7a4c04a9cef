// What kernels move springs by, and where particles lie. The layouts of SpringBatches have a group each, `find_squared`, the
// springs' squared lengths, and `move`, which moves their ends towards each other, or away along where they were before: see
// stretch_runs.h, stretch_pairs.h, stretch_gathered.h. For the .cpp files of kernels, as lanes.h.
#pragma once

#include "base/types.h"

#include <cstddef>

namespace sprung {

/// What ends move, as parts of the way to the other.
template <class Lanes>
struct Moves {
  Lanes first;
  Lanes second;
};

/// No moves along where springs were before.
struct NoPushes {};

[[gnu::always_inline]] inline std::ptrdiff_t place_of(Index particle) { return std::ptrdiff_t{3} * particle; }

}  // namespace sprung
