// The output of a run: frames in the formats that are asked for, record.bin, diagnostics.csv, forces.csv on request, run.json.
#pragma once

#include "base/ordered_worker.h"
#include "output/exporters/exporter.h"
#include "output/output_folder.h"
#include "output/output_frame.h"
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

/// Writes one frame after the other, in a thread of its own. A frame is complete (its files in all formats, its part of record.bin,
/// rows of diagnostics.csv and forces.csv) or absent. run.json is updated with each frame. If a frame cannot be written, the next
/// call of a member that throws FileError says so; no later frame is written then. Not for several threads at the same time.
class RunOutput {
 public:
  /// Writes run.json and the heads of record.bin, diagnostics.csv and, if the simulator records forces, forces.csv. Throws
  /// FileError, and InputError for names that are not valid folder names.
  RunOutput(OutputFolder folder, const RunFacts& facts, const Simulator& simulator);

  /// Goes on with the run of the folder after this checkpoint: takes back what was written later. `monitor` gets what the caller
  /// gave with the checkpoint. The simulator is at the start; restore it from the checkpoint after this call. Throws FileError if
  /// files of the run are shorter than at the checkpoint, or if they would have other names; nothing is changed then.
  RunOutput(OutputFolder folder, const RunFacts& facts, const Simulator& simulator, const Checkpoint& from, std::string& monitor);

  /// Copies the simulator's present state and has it written as the next frame. Waits if the frames before are not yet written.
  /// Requires the simulator of the constructor. Throws FileError if a frame before could not be written.
  void write_frame(const Simulator& simulator, const FrameDiagnostics& diagnostics);

  /// The same for a frame that was copied before, with a record unless the facts ask for none. Its progress goes on from that of
  /// the frame before.
  void write_frame(OutputFrame output);

  /// Waits until all frames are on the disk. Throws FileError.
  void flush();

  /// Adds a warning; the next frame, or `finish`, writes it to run.json.
  void add_warning(const std::string& warning) { progress_.warnings.push_back(warning); }

  /// Call it after write_frame(). Waits as flush() and throws as it. Writes a checkpoint, with what the caller remembers of the
  /// frames so far, if there is none or the interval of the facts has passed since the last one. Returns why it could not be
  /// written; empty without a failure. A former checkpoint then stays.
  std::string write_due_checkpoint(const Simulator& simulator, const std::string& monitor);

  /// Writes a checkpoint unless the facts ask for none. Call it before warnings that count all frames. Requires that the simulator
  /// is at the last frame that was written. Returns as write_due_checkpoint().
  std::string write_checkpoint_now(const Simulator& simulator, const std::string& monitor);

  /// Also frames that are still being written, until a call says that one could not be.
  [[nodiscard]] int frames_written() const { return progress_.frames_written; }

  /// Writes the formats that have one file for all frames, from the record; then the outcome of the run to run.json: `done`,
  /// `interrupted`, `diverged: ...`. After `failed: ...` no format is written. Throws FileError.
  void finish(const std::string& outcome);

  /// What the further formats cannot hold of this run, one line each. `tears`: springs may break.
  [[nodiscard]] std::vector<std::string> losses(bool tears) const;

 private:
  /// What is written of a frame.
  struct Frame {
    ExportedFrame exported;   ///< empty without record.bin and formats
    std::string diagnostics;  ///< row of diagnostics.csv
    std::string forces;       ///< rows of forces.csv
    RunProgress progress;     ///< with this frame
  };

  /// Writes nothing yet.
  RunOutput(const RunFacts& facts, const Simulator& simulator, OutputFolder folder);

  void write(const Frame& frame);
  void take_back_progress();
  void write_summary(RunProgress& progress);
  void write_whole_files();
  void take_back_frames(const RunCheckpoint& to);
  [[nodiscard]] std::vector<std::string> patterns() const;

  OutputFolder folder_;
  bool has_forces_;
  std::optional<RunRecorder> recorder_;  ///< none without record.bin and formats
  bool has_record_;
  std::vector<std::string> formats_;
  std::vector<std::unique_ptr<Exporter>> exporters_;  ///< of these formats
  RunSummary summary_;
  RunProgress progress_;  ///< with the frames that are still being written
  RunProgress written_;   ///< with those that are; of the worker
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double seconds_before_ = 0.0;  ///< of the run, before this output was made [s], wall time
  double checkpoint_interval_;   ///< [s]; 0: none
  RunIdentity identity_{};       ///< empty without checkpoints
  std::optional<std::chrono::steady_clock::time_point> last_checkpoint_{};
  OrderedWorker worker_;  ///< the last member: it ends before what its jobs use
};

}  // namespace sprung
