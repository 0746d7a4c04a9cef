// The order in which a pass takes the batches of SpringBatches. Batches without a common particle may be swapped without changing
// a bit. Batches with one keep the order of their colours.
#pragma once

#include "dynamics/stretch_limit/spring_batches.h"

namespace sprung {

/// One colour after the other; each colour is a stage.
void order_by_colour(const std::vector<Index>& colour_begin, SpringBatches& batches);

/// For narrow networks, whose springs join particles at most `band` apart: all colours of some particles before those of the next,
/// while the particles are in the cache. Particles are cut into chunks. Batches of one chunk alone run in parallel with those of
/// other chunks; the batches between chunks follow.
void order_by_locality(const std::vector<Index>& colour_begin, Index band, Index particles, SpringBatches& batches);

}  // namespace sprung
