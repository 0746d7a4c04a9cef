// A frame of a run as RunOutput writes it: copied from the simulator, and written then or later.
#pragma once

#include "output/record/recorded_model.h"
#include "output/run_summary.h"
#include "simulation/diagnostics.h"

#include <string>

namespace sprung {

class Simulator;

struct OutputFrame {
  RecordedFrame state;      ///< empty without record.bin and formats
  std::string diagnostics;  ///< row of diagnostics.csv
  std::string forces;       ///< rows of forces.csv; empty if the simulator records no forces
  RunProgress progress;     ///< of the run with this frame
};

/// Copies the simulator's present state as the frame that follows those of `before`. Without `with_state` the
/// frame is for a run without record.bin and formats.
[[nodiscard]] OutputFrame output_frame(const Simulator& simulator, const FrameDiagnostics& diagnostics, const RunProgress& before,
                                       bool with_state);

}  // namespace sprung
