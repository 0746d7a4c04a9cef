// Reads what a run wrote: its summary, its diagnostics and its frames.
#pragma once

#include "output/record/record_reader.h"
#include "output/record/recorded_model.h"
#include "output/run_summary.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

/// The table of diagnostics.csv; fields without a value are NaN.
struct RecordedDiagnostics {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  ///< one per frame, each as long as the columns
};

/// Springs that broke.
struct BrokenSprings {
  int frame = 0;               ///< the first one in which they are broken
  std::vector<Index> springs;  ///< of the model, ascending
};

/// What is read of a run.
enum class RunParts : std::uint8_t { all, diagnostics };

/// A run that was written into a folder. Everything comes from its files, so the folder can be moved. Model and frames come from
/// record.bin. Without it they come from the OBJ files: each vertex then counts as a particle, and missing() says what is not
/// known.
///
/// Const members may be called from several threads at the same time. Construction reads the model and the diagnostics. frame()
/// reads one frame from the disk in each call, broken_springs() a part of each frame; all others take constant time.
class RecordedRun {
 public:
  /// Throws InputError that names what a folder lacks to be a run with at least one frame: keys of run.json, or both record.bin
  /// and the OBJ files of its first frame. Throws FileError if run.json or a file that it needs cannot be read. With
  /// RunParts::diagnostics the model stays empty, a run may lack frames, and frame() must not be called.
  explicit RecordedRun(std::filesystem::path folder, RunParts parts = RunParts::all);

  /// File name of the scene, or name of the folder if the run has none.
  [[nodiscard]] const std::string& title() const { return title_; }
  [[nodiscard]] const std::string& scene() const { return scene_; }  ///< JSON text; empty if the run has none
  [[nodiscard]] int frames() const { return frames_; }               ///< that can be read
  [[nodiscard]] double frame_rate() const { return frame_rate_; }    ///< [1/s]
  [[nodiscard]] double step() const { return step_; }                ///< [s]
  [[nodiscard]] int steps_per_frame() const { return steps_per_frame_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
  [[nodiscard]] const RecordedDiagnostics& diagnostics() const { return diagnostics_; }
  [[nodiscard]] const std::vector<TornFaces>& torn_faces() const { return torn_faces_; }
  [[nodiscard]] const RecordedModel& model() const { return record_ ? record_->model() : model_of_obj_; }

  /// By frame, ascending. Throws as frame().
  [[nodiscard]] std::vector<BrokenSprings> broken_springs() const;

  /// Whether springs, pins, velocities and contact are known.
  [[nodiscard]] bool is_complete() const { return record_.has_value(); }

  /// What cannot be shown, and why, in one line; empty if nothing is missing.
  [[nodiscard]] const std::string& missing() const { return missing_; }

  /// A frame, counted from 1, at most frames(). Throws FileError if a file cannot be read, InputError if it does not fit the
  /// model.
  [[nodiscard]] RecordedFrame frame(int number) const;

 private:
  void read_summary(RunParts parts);
  void read_record(int frames_written, const std::string& fingerprint);
  void read_obj_model(const std::vector<std::string>& patterns);
  void read_diagnostics();
  void read_torn_faces(const std::string& torn_faces);
  [[nodiscard]] RecordedFrame frame_of_obj(int number) const;
  [[nodiscard]] Points obj_positions(const std::string& pattern, int frame, Eigen::Index count) const;

  std::filesystem::path folder_;
  std::string title_;
  std::string scene_;
  int frames_ = 0;
  double frame_rate_ = 30.0;
  double step_ = 0.0;
  int steps_per_frame_ = 1;
  std::vector<std::string> warnings_;
  std::string missing_;
  RecordedDiagnostics diagnostics_;
  std::vector<TornFaces> torn_faces_;
  std::optional<RecordReader> record_;
  // Without a record:
  RecordedModel model_of_obj_;
  std::vector<std::string> body_patterns_;
  std::vector<std::string> obstacle_patterns_;
};

}  // namespace sprung
