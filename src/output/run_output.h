// The output of a run: OBJ sequences of bodies and obstacles, record.bin, diagnostics.csv, forces.csv on request, run.json.
#pragma once

#include "output/exporters/exporter.h"
#include "output/obj_sequence.h"
#include "output/output_folder.h"
#include "output/run_checkpoint.h"
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

  /// Goes on with the run of the folder after this checkpoint: takes back what was written later. `monitor` gets what the caller
  /// gave with the checkpoint. The simulator is at the start; restore it from the checkpoint after this call. Throws FileError if
  /// files of the run are shorter than at the checkpoint, or if they would have other names; nothing is changed then.
  RunOutput(OutputFolder folder, const RunFacts& facts, const Simulator& simulator, const Checkpoint& from, std::string& monitor);

  /// Writes the OBJ files of all bodies and moving obstacles at the simulator's present time, and the frame's part of the other
  /// files. The first call also writes the static obstacles and copies the materials of bodies. Requires the simulator of the
  /// constructor. Throws FileError; no part of the frame then remains.
  void write_frame(const Simulator& simulator, const FrameDiagnostics& diagnostics);

  /// Adds a warning; the next frame, or `finish`, writes it to run.json.
  void add_warning(const std::string& warning) { progress_.warnings.push_back(warning); }

  /// Call it after write_frame(). Writes a checkpoint, with what the caller remembers of the frames so far, if there is none or the
  /// interval of the facts has passed since the last one. Returns why it could not be written; empty without a failure. A former
  /// checkpoint then stays.
  std::string write_due_checkpoint(const Simulator& simulator, const std::string& monitor);

  /// Writes a checkpoint unless the facts ask for none. Call it before warnings that count all frames. Requires that the simulator
  /// is at the last frame that was written. Returns as write_due_checkpoint().
  std::string write_checkpoint_now(const Simulator& simulator, const std::string& monitor);

  [[nodiscard]] int frames_written() const { return progress_.frames_written; }

  /// Writes the formats that have one file for all frames, from the record; then the outcome of the run to run.json: `done`,
  /// `interrupted`, `diverged: ...`. After `failed: ...` no format is written. Throws FileError.
  void finish(const std::string& outcome);

  /// What the further formats cannot hold of this run, one line each. `tears`: springs may break.
  [[nodiscard]] std::vector<std::string> losses(bool tears) const;

 private:
  /// Writes nothing yet.
  RunOutput(const RunFacts& facts, const Simulator& simulator, OutputFolder folder);

  void write_summary();
  void write_whole_files();
  void take_back_frames(const RunCheckpoint& to);
  [[nodiscard]] std::vector<std::string> patterns() const;

  OutputFolder folder_;
  std::vector<ObjSequence> sequences_;
  std::vector<CopiedFile> copies_;
  bool has_forces_;
  std::optional<RunRecorder> recorder_;  ///< none without record.bin and further formats
  bool has_record_;
  std::vector<std::string> formats_;                  ///< further ones
  std::vector<std::unique_ptr<Exporter>> exporters_;  ///< of these formats
  RunSummary summary_;
  RunProgress progress_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double seconds_before_ = 0.0;  ///< of the run, before this output was made [s], wall time
  double checkpoint_interval_;   ///< [s]; 0: none
  RunIdentity identity_{};       ///< empty without checkpoints
  std::optional<std::chrono::steady_clock::time_point> last_checkpoint_{};
};

}  // namespace sprung
