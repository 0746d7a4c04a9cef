// The output of a run: OBJ sequences of bodies and obstacles, record.bin, diagnostics.csv, forces.csv on request, run.json.
#pragma once

#include "output/obj_sequence.h"
#include "output/output_folder.h"
#include "output/run_recorder.h"
#include "output/run_summary.h"
#include "simulation/diagnostics.h"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

class Simulator;

/// Writes one frame after the other. A frame is complete (OBJ files of all bodies, its part of record.bin, rows of diagnostics.csv
/// and forces.csv) or absent. run.json is updated with each frame. Not for several threads at the same time. write_frame() is
/// costly: it formats and writes all positions; it reads the simulator, which must not step meanwhile.
class RunOutput {
 public:
  /// Writes run.json and the heads of record.bin, diagnostics.csv and, if the simulator records forces, forces.csv. Throws
  /// FileError, and InputError for names that are not valid folder names.
  RunOutput(OutputFolder folder, const RunFacts& facts, const Simulator& simulator);

  /// Writes the OBJ files of all bodies and moving obstacles at the simulator's present time, and the frame's part of the other
  /// files. The first call also writes the static obstacles and copies the materials of bodies. Requires the simulator of the
  /// constructor. Throws FileError; no part of the frame then remains.
  void write_frame(const Simulator& simulator, const FrameDiagnostics& diagnostics);

  /// Adds a warning; the next frame, or `finish`, writes it to run.json.
  void add_warning(const std::string& warning) { summary_.add_warning(warning); }

  /// Writes the outcome of the run to run.json: `done`, `interrupted`, `diverged: ...`. Throws FileError.
  void finish(const std::string& outcome);

 private:
  void write_summary();
  [[nodiscard]] std::vector<std::string> patterns() const;

  OutputFolder folder_;
  std::vector<ObjSequence> sequences_;
  std::vector<CopiedFile> copies_;
  bool has_forces_;
  std::optional<RunRecorder> recorder_;  ///< none without record.bin
  RunSummary summary_;
  RunProgress progress_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace sprung
