// What to warn of in the frames of a run.
#pragma once

#include "dynamics/tethers/lra_paths.h"
#include "simulation/diagnostics.h"

#include <optional>
#include <string>

namespace sprung {

class Simulator;

/// What the frames so far were like.
struct FrameMemory {
  /// Frames in which the stretch limit was missed.
  struct Missed {
    int frames = 0;
    double largest = 0.0;  ///< fraction of a rest length
    int worst_frame = 0;
    PinStretch pins{};  ///< in that frame
  };

  Missed missed{};
  int frames = 0;
  int truncated_frames = 0;  ///< frames in which truncation stopped many particles
};

/// Call it after each frame; of the diagnostics, it reads the number, the sums over steps and the excess.
void note_frame(const Simulator& simulator, const FrameDiagnostics& frame, FrameMemory& memory);

// Warnings with their remedies; none without a reason.

/// Vertices without an admissible position.
[[nodiscard]] std::optional<std::string> infeasible_warning(const FrameDiagnostics& frame);

/// Cells that are inside out.
[[nodiscard]] std::optional<std::string> inverted_warning(const Simulator& simulator, const FrameDiagnostics& frame);

/// A stretch limit that was missed in any frame so far.
[[nodiscard]] std::optional<std::string> missed_limit_warning(const Simulator& simulator, const FrameMemory& memory);

/// A thickness that is too small for the step, if contact stopped many particles in many of the frames so far.
[[nodiscard]] std::optional<std::string> thin_bodies_warning(const Simulator& simulator, const FrameMemory& memory);

}  // namespace sprung
