// What a frame is measured by.
#pragma once

#include "simulation/simulator.h"

#include <optional>

namespace sprung {

struct FrameDiagnostics {
  int frame = 1;                       ///< frame 1 is the state at time 0
  double time = 0.0;                   ///< [s]
  double kinetic_energy = 0.0;         ///< [J]
  double elastic_energy = 0.0;         ///< [J]
  double gravity_energy = 0.0;         ///< [J]
  double max_stretch = 0.0;            ///< largest (|s| - d) / d of structural springs
  double stretch_excess = 0.0;         ///< largest in the frame's steps beyond the stretch limit
  Index contacts = 0;                  ///< particles that obstacles push at the end
  std::optional<double> min_distance;  ///< smallest distance of a particle from an obstacle [m]; none without obstacles, or when
                                       ///< all are farther than the network is large
  Index truncated = 0;                 ///< in all of the frame's steps
  Index infeasible = 0;                ///< in all of the frame's steps
  std::int64_t substeps = 0;           ///< in which the frame's steps were made
  double smallest_step = 0.0;          ///< length of the smallest [s]; 0 when no step was made
  std::int64_t limit_solves = 0;       ///< linear systems of the stretch limit, in all of the frame's steps
  double frame_ms = 0.0;               ///< wall time of computing the frame
};

/// Runs a simulator frame by frame. Keeps a reference to it.
class FrameRunner {
 public:
  /// Requires steps_per_frame >= 1.
  FrameRunner(Simulator& simulator, int steps_per_frame);

  /// Diagnostics of the state at time 0.
  [[nodiscard]] FrameDiagnostics first_frame() const;

  /// Runs the steps of the next frame. Throws StepError.
  FrameDiagnostics next_frame();

 private:
  Simulator& simulator_;
  int steps_per_frame_;
  int frame_ = 1;
};

}  // namespace sprung
