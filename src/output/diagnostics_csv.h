// diagnostics.csv: a row a frame.
#pragma once

#include "simulation/diagnostics.h"

#include <string>

namespace sprung {

/// The names of the columns, as a line.
[[nodiscard]] std::string csv_head();

/// A frame's row, as a line; fields of what is not known are empty.
[[nodiscard]] std::string csv_row(const FrameDiagnostics& frame);

}  // namespace sprung
