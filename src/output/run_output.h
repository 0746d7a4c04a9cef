// What a run leaves behind: OBJ sequences of bodies, obstacles as placed, diagnostics.csv, run.json.
#pragma once

#include "output/obj_sequence.h"
#include "output/output_folder.h"
#include "output/run_record.h"
#include "simulation/diagnostics.h"
#include "simulation/simulator.h"

#include <chrono>
#include <string>
#include <vector>

namespace sprung {

/// Writes frames as they come. Each frame is there as a whole (OBJ files of all bodies, row of diagnostics.csv) or not at all, and
/// run.json is up to date after each.
class RunOutput {
 public:
  /// Writes run.json and the head of diagnostics.csv. Throws FileError, and InputError for names that cannot be folders.
  RunOutput(OutputFolder folder, const RunFacts& facts, const Simulator& simulator);

  /// Writes the OBJ files of all bodies (and of moving obstacles) for the simulator's present state, and the frame's row. The first
  /// call also writes the obstacles that stand still. Requires the simulator of the constructor. Throws FileError; then nothing of
  /// the frame remains.
  void write_frame(const Simulator& simulator, const FrameDiagnostics& diagnostics);

  /// Adds a warning that the run gave rise to; the next frame, or `finish`, writes it into run.json.
  void add_warning(const std::string& warning) { record_.add_warning(warning); }

  /// Writes how the run ended into run.json: `done`, `interrupted`, `diverged: ...`. Throws FileError.
  void finish(const std::string& outcome);

 private:
  void write_record();

  OutputFolder folder_;
  std::vector<ObjSequence> sequences_;
  RunRecord record_;
  RunProgress progress_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace sprung
