// Warnings about a run, while it proceeds and at its end.
#pragma once

#include "output/run_output.h"
#include "simulation/frame_watch.h"
#include "simulation/monitoring/energy_watch.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sprung {

/// What RunWatch remembers of the frames so far.
struct RunWatchMemory {
  bool infeasible = false;
  bool inverted = false;
  FrameMemory frames{};
  EnergyGainMemory energy{};
  std::vector<char> handed_over{};  ///< by body
  std::int64_t last_break = 0;      ///< number of the step after which a rod or spring broke last
};

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

  /// Prints a warning and adds it to run.json.
  void warn(const std::string& warning);

  /// What it remembers, as bytes, for a run that goes on later.
  [[nodiscard]] std::string memory() const;
  /// Throws BytesError.
  void restore(const std::string& memory);

 private:
  void note_infeasible(const FrameDiagnostics& frame);
  void note_inverted(const FrameDiagnostics& frame);
  void note_handovers();
  void note_broken(const FrameDiagnostics& frame);
  void warn_of_self_crossings();

  const Simulator& simulator_;
  RunOutput& output_;
  bool quiet_;
  EnergyGain energy_;
  RunWatchMemory memory_;
};

}  // namespace sprung
