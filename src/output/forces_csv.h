// forces.csv: a row per frame and pin or attachment.
#pragma once

#include "simulation/reaction.h"

#include <string>
#include <vector>

namespace sprung {

/// The line of column names: frame, time [s], name of the pin or attachment, and the force [N] on its (first) body, a mean
/// since the frame before.
[[nodiscard]] std::string forces_csv_head();

/// The lines of a frame at `time` [s], in the given order.
[[nodiscard]] std::string forces_csv_rows(int frame, double time, const std::vector<Reaction>& reactions);

}  // namespace sprung
