// Warnings about a run, while it proceeds and at its end.
#pragma once

#include "dynamics/tethers/lra_paths.h"
#include "output/run_output.h"
#include "simulation/diagnostics.h"
#include "simulation/monitoring/energy_watch.h"

#include <string>
#include <vector>

namespace sprung {

/// Prints warnings and adds them to run.json.
class RunWatch {
 public:
  /// A quiet run prints warnings, but no messages. Keeps references to the simulator and the output.
  RunWatch(const Simulator& simulator, RunOutput& output, bool quiet);

  /// Call it after each frame. Reports attachments that broke, the first infeasible vertices, and each body whose stretch limit is
  /// handed over to another solver. Throws FileError.
  void note_frame(const FrameDiagnostics& frame);

  /// Call it after the last frame. Warns if the stretch limit was missed, if a thickness is too small for the step, if the energy
  /// of an undriven scene rose, and if a body without self-contact crosses itself now. Throws FileError.
  void finish();

 private:
  void warn(const std::string& warning);
  void note_infeasible(const FrameDiagnostics& frame);
  void note_inverted(const FrameDiagnostics& frame);
  void note_stretch(const FrameDiagnostics& frame);
  void note_handovers();
  void note_broken(const FrameDiagnostics& frame);
  void note_truncated(const FrameDiagnostics& frame);
  void warn_of_missed_limit();
  void warn_of_thin_bodies();
  void warn_of_self_crossings();
  [[nodiscard]] std::string remedy_for_stretch() const;

  struct Missed {
    int frames = 0;
    double largest = 0.0;  ///< fraction of a rest length
    int worst_frame = 0;
    PinStretch pins;  ///< in that frame
  };

  const Simulator& simulator_;
  RunOutput& output_;
  bool quiet_;
  bool infeasible_ = false;
  bool inverted_ = false;
  Missed missed_;
  EnergyGain energy_;
  int frames_ = 0;
  int truncated_frames_ = 0;       ///< frames in which truncation stopped many particles
  std::vector<bool> handed_over_;  ///< by body
  std::int64_t last_break_ = 0;    ///< number of the step after which a rod or spring broke last
};

}  // namespace sprung
