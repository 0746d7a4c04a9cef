// The folder of a sweep: manifest.json, results.csv, journals of what ended, and a folder for each run.
#pragma once

#include "scene/load_scene.h"
#include "sweep/sweep_plan.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace sprung {

inline constexpr const char* kManifestFile = "manifest.json";
inline constexpr const char* kResultsFile = "results.csv";

/// What a sweep is. A folder continues with the same settings alone.
struct SweepSettings {
  SceneSource scene;  ///< absolute paths
  SweepRequest request;
  std::vector<std::string> formats{"none"};  ///< of the frames
  std::optional<int> frames{};
  std::string engine = "local";
  int array_size = 0;         ///< tasks of the array job; 0 without one
  std::string first_scene{};  ///< JSON text of the resolved scene of run 1
};

/// What may change while a sweep goes on.
struct SweepProgress {
  int jobs = 1;              ///< processes at the same time, of a task if there are several
  double checkpoint = 60.0;  ///< [s]
  std::string job{};         ///< the last array job; empty without one
};

enum class RunStatus : std::uint8_t { pending, running, done, failed };

struct RunState {
  RunStatus status = RunStatus::pending;
  int exit_code = -1;     ///< -1: it has not ended, or a signal ended it
  double seconds = 0.0;   ///< wall time of the process that ended it [s]
  std::string message{};  ///< why it failed
  std::string columns{};  ///< head and row of results.csv that its output gives; empty without diagnostics
  std::string row{};
};

struct RunCounts {
  int done = 0;
  int failed = 0;
  int running = 0;
  int pending = 0;
  double mean_seconds = 0.0;  ///< of those that ended
};

/// A run that ended is a line of a journal, which is appended with one call, so that it is there or not whenever the writer dies.
/// manifest.json and results.csv are made from the journals; each is replaced as a whole. Several processes may append to journals
/// of their own; one at a time may write the manifest, under the lock of the folder.
class SweepFolder {
 public:
  /// Opens the sweep of a folder. Throws InputError if there is none.
  explicit SweepFolder(const std::filesystem::path& folder);
  /// A sweep that is not written yet. Throws InputError as SweepPlan.
  SweepFolder(std::filesystem::path folder, SweepSettings settings);

  /// Throws InputError with the differences if the folder holds a sweep of other settings, and FileError if it holds other files.
  void check_is_same_or_free() const;

  /// Reads the journals again.
  void read_journals();

  /// Appends to the journal of the run's task. Only one process at a time may do so. Throws FileError; the journal is then
  /// unchanged.
  void note(int run, RunState state);

  /// Marks a run for manifest.json, without a line in a journal.
  void mark_running(int run) { states_[static_cast<std::size_t>(run - 1)].status = RunStatus::running; }
  void mark_pending(int run) { states_[static_cast<std::size_t>(run - 1)].status = RunStatus::pending; }

  /// Throws FileError; the former files then stay.
  void write_manifest() const;
  void write_results() const;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path run_folder(int run) const { return path_ / "runs" / run_name(run); }
  [[nodiscard]] const SweepPlan& plan() const { return plan_; }
  [[nodiscard]] const SweepSettings& settings() const { return settings_; }
  [[nodiscard]] SweepProgress& progress() { return progress_; }
  [[nodiscard]] const SweepProgress& progress() const { return progress_; }
  [[nodiscard]] const RunState& state(int run) const { return states_[static_cast<std::size_t>(run - 1)]; }
  [[nodiscard]] RunCounts counts() const;

  /// The task that a run belongs to, counted from 0. Neighbours belong to different ones, as they often take the same time.
  [[nodiscard]] int task_of(int run) const { return settings_.array_size > 0 ? (run - 1) % settings_.array_size : 0; }

 private:
  struct Manifest;
  SweepFolder(std::filesystem::path folder, Manifest manifest);
  [[nodiscard]] static Manifest read_manifest(const std::filesystem::path& folder);

  std::filesystem::path path_;
  SweepSettings settings_;
  SweepProgress progress_{};
  SweepPlan plan_;
  std::vector<RunState> states_;
  std::set<int> journals_{};  ///< tasks whose journals end with a whole line
};

/// Whether a folder has a manifest.
[[nodiscard]] bool has_sweep(const std::filesystem::path& folder);

/// The values of a run's output for results.csv: the last row of its diagnostics; the largest `max_stretch` and `stretch_excess` of
/// all frames; the wall time of the run [s]. Both texts are empty if there are none.
struct RunResult {
  std::string columns;
  std::string row;
};
[[nodiscard]] RunResult result_of_run(const std::filesystem::path& folder);

}  // namespace sprung
