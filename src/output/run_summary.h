// run.json: scene, settings, progress and outcome of a run.
#pragma once

#include "base/types.h"
#include "geometry/obj_source/obj_source.h"
#include "network/step_adjustment.h"
#include "output/record/recorded_model.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

inline constexpr const char* kDiagnosticsFile = "diagnostics.csv";
inline constexpr const char* kCheckpointFile = "checkpoint.bin";

inline constexpr const char* kRunSummaryFile = "run.json";

/// What an export of the run as HTML writes into its folder. It is listed among the run's files, so that it goes with them.
inline constexpr const char* kAnimationFile = "animation.html";

/// Facts that are known before the run starts.
struct RunFacts {
  std::string scene{};       ///< resolved scene as JSON text, or empty
  double frame_rate = 30.0;  ///< [1/s]
  int frames = 1;            ///< to write
  int steps_per_frame = 1;
  int threads = 1;
  std::string stretch_solver{};         ///< of the stretch limit; empty without one
  std::optional<std::uint64_t> seed{};  ///< of the scene; none if nothing uses it
  std::vector<StepAdjustment> adjustments{};
  std::vector<std::string> warnings{};
  ObjSources sources{};                      ///< of bodies that are written as their files are
  std::string scene_file{};                  ///< name of the scene's file, without its folders; empty if there is none
  BodyMaterials materials{};                 ///< of bodies that have one
  bool write_record = true;                  ///< whether record.bin is written
  std::vector<std::string> formats{"obj"};   ///< of the frames, names of exporter_formats()
  std::vector<std::string> later_formats{};  ///< further ones, which the caller makes of the run when it has ended
  double checkpoint_interval = 0.0;          ///< at most so often a checkpoint is written [s], wall time; 0: never
};

/// A body whose stretch limit was handed over from Gauss-Seidel passes to Newton.
struct NewtonFrom {
  std::string body;
  std::int64_t step = 0;  ///< after which it was handed over
};

/// Faces of a body that tore.
struct TornFaces {
  std::string body;
  int frame = 0;             ///< the first one without them
  std::vector<Index> faces;  ///< counted from 0 in the first frame, ascending
};

/// A rod or spring of an attachment that broke.
struct BrokenAttachment {
  std::string name;        ///< of the attachment
  std::string body;        ///< at its first end
  Index particle = kNone;  ///< of the body
  std::int64_t step = 0;   ///< after which it broke
};

/// The frame that shows a state first, which a step of this number reached. Frame 1 is the state at time 0.
[[nodiscard]] std::int64_t frame_of_step(std::int64_t step, std::int64_t steps_per_frame);

/// Progress of a run.
struct RunProgress {
  std::string outcome = "running";  ///< `running`, `done`, `interrupted`, `diverged: ...`
  int frames_written = 0;
  std::int64_t steps = 0;
  std::int64_t substeps = 0;      ///< summed over the steps
  double smallest_step = 0.0;     ///< length of the shortest substep [s]; 0 without steps
  std::int64_t limit_solves = 0;  ///< linear systems solved for the stretch limit
  std::vector<NewtonFrom> newton_from{};
  std::vector<TornFaces> torn_faces{};
  std::vector<BrokenAttachment> broken_attachments{};
  double wall_seconds = 0.0;            ///< of the run so far [s], including writing
  std::vector<std::string> warnings{};  ///< beside those of the facts
};

/// The text of run.json.
class RunSummary {
 public:
  /// `step` [s]; `files` are the patterns of all files of the run. Requires that the scene is JSON text or empty.
  RunSummary(const RunFacts& facts, double step, const std::vector<std::string>& files);
  ~RunSummary();
  RunSummary(RunSummary&&) noexcept;

  /// Says which record.bin belongs to the run (see fingerprint()).
  void set_record(const std::string& fingerprint);

  /// Keeps the files of exports into the run's folder, by their patterns.
  void set_exports(const std::vector<std::string>& patterns);

  [[nodiscard]] std::string text(const RunProgress& progress) const;

 private:
  struct Document;
  std::unique_ptr<Document> document_;
};

/// What run.json says of a run that may go on.
struct WrittenRun {
  std::string outcome;
  int frames_written = 0;
  std::string scene;                 ///< JSON text; empty if the run has none
  std::vector<std::string> files;    ///< patterns
  std::vector<std::string> formats;  ///< `formats` and `later_formats` of its facts
};

/// Nothing if the file cannot be read or is not a run.json of Sprung.
[[nodiscard]] std::optional<WrittenRun> written_run(const std::filesystem::path& run_summary);

/// The patterns of a run's files from its run.json; nothing if the file cannot be read or is not a run.json of Sprung.
[[nodiscard]] std::optional<std::vector<std::string>> files_of_run(const std::filesystem::path& run_summary);

/// The patterns of the files that exports wrote into the folder of a run, which another export may replace.
[[nodiscard]] std::vector<std::string> exports_of_run(const std::filesystem::path& run_summary);

/// Adds patterns to the files of the run in a folder and to those of its exports, so that a run that replaces it removes what an
/// export wrote there. Requires a folder with a run. Throws FileError.
void add_files_to_run(const std::filesystem::path& folder, const std::vector<std::string>& patterns);

}  // namespace sprung
