// run.json: what was run, with what, and how it ended.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

inline constexpr const char* kRunRecordFile = "run.json";

/// What is known of a run before it starts.
struct RunFacts {
  std::string scene{};       ///< as resolved, JSON text; may be empty
  double frame_rate = 30.0;  ///< [1/s]
  int frames = 1;            ///< that the run is to write
  int steps_per_frame = 1;
  int threads = 1;
  std::string stretch_solver{};  ///< what holds the stretch limit; empty without one
  std::uint64_t seed = 0;        ///< of what is random; nothing is yet
  std::vector<std::string> warnings{};
};

/// A body whose stretch limit a global solve took over from passes.
struct NewtonFrom {
  std::string body;
  std::int64_t step = 0;  ///< after which it did
};

/// How far a run has come.
struct RunProgress {
  std::string outcome = "running";  ///< `running`, `done`, `interrupted`, `diverged: ...`
  int frames_written = 0;
  std::int64_t steps = 0;
  std::int64_t substeps = 0;      ///< in which the steps were made
  double smallest_step = 0.0;     ///< length of the smallest of them [s]; 0 when no step was made
  std::int64_t limit_solves = 0;  ///< linear systems of the stretch limit
  std::vector<NewtonFrom> newton_from{};
  double wall_seconds = 0.0;  ///< since the output was opened, writing included
};

/// The text of run.json.
class RunRecord {
 public:
  /// `step` [s]; `files` are the patterns of all files of the run. Requires that the scene is JSON text or empty.
  RunRecord(const RunFacts& facts, double step, const std::vector<std::string>& files);
  ~RunRecord();

  /// Adds to the warnings that the facts brought.
  void add_warning(const std::string& warning);

  [[nodiscard]] std::string text(const RunProgress& progress) const;

 private:
  struct Document;
  std::unique_ptr<Document> document_;
};

/// The patterns of a run's files as its run.json lists them; nothing when the file cannot be read or is not a run.json of ours.
[[nodiscard]] std::optional<std::vector<std::string>> files_of_run(const std::filesystem::path& run_record);

}  // namespace sprung
