// diagnostics.csv: one row per frame.
#pragma once

#include "simulation/diagnostics.h"

#include <string>

namespace sprung {

/// The line of column names.
[[nodiscard]] std::string csv_head();

/// The line of a frame. Fields without a value are empty.
[[nodiscard]] std::string csv_row(const FrameDiagnostics& frame);

}  // namespace sprung
