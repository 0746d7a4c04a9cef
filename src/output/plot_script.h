// The gnuplot script that draws the diagnostics of runs.
#pragma once

#include "output/recorded_run.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sprung {

enum class PlotFormat : std::uint8_t { png, svg };

/// A run to draw.
struct PlottedRun {
  std::string title;
  RecordedDiagnostics diagnostics;
};

/// Four plots over time: energies, stretch, contacts, and the time that frames took. Of one run the energies are kinetic, elastic,
/// gravity and their sum; of several, each run has one colour, and the energy is the sum. gnuplot 5 writes the picture to `file`.
/// Requires at least one run. Columns that a run lacks are left out.
[[nodiscard]] std::string plot_script(const std::vector<PlottedRun>& runs, const std::string& file, PlotFormat format);

}  // namespace sprung
