// In which order a pass takes the parts of SpringBatches. Parts that share no particle may change places without changing a bit:
// so much order as colours have is kept between those that do.
#pragma once

#include "dynamics/stretch_limit/spring_batches.h"

namespace sprung {

/// One colour after the other, `colour_begin` as the parts lie: a stage each.
void order_by_colour(const std::vector<Index>& colour_begin, SpringBatches& batches);

/// For narrow networks, whose springs join particles at most `band` apart: all colours of some particles before those of the next,
/// while they are in the cache. Particles are cut into chunks; what concerns one chunk alone can be done at the same time as what
/// concerns others, and then what lies between them.
void order_by_place(const std::vector<Index>& colour_begin, Index band, Index particles, SpringBatches& batches);

}  // namespace sprung
