// What a run adds to the checkpoint of its simulator, and whether a run can go on from one.
#pragma once

#include "base/files/binary_archive.h"
#include "output/output_folder.h"
#include "output/run_summary.h"
#include "simulation/checkpoint.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

class Model;
class Simulator;

/// What must be the same if a run goes on: the scene without its duration and the paths of files, and what was read from these.
struct RunIdentity {
  std::map<std::string, std::string> keys;            ///< JSON text of each value of the scene, by its path
  std::map<std::string, std::uint64_t> fingerprints;  ///< of what was built, by `body "rope"`, `obstacle "bunny"`
};

struct RunCheckpoint {
  RunIdentity identity;
  std::vector<std::string> files;  ///< patterns
  RunProgress progress;
  std::string monitor;                 ///< what the caller of RunOutput remembers of the frames so far
  std::uint64_t record_size = 0;       ///< of record.bin [bytes]
  std::uint64_t diagnostics_size = 0;  ///< of diagnostics.csv
  std::uint64_t forces_size = 0;       ///< of forces.csv; 0 without one
};

/// The simulator is at the start. Requires that `scene` is JSON text or empty.
[[nodiscard]] RunIdentity identity_of(const std::string& scene, const Simulator& simulator);

/// The fingerprint of each body with its start, `body "rope"`, and of each obstacle's mesh, `obstacle "bunny"`. Costs a hash of
/// all.
[[nodiscard]] std::map<std::string, std::uint64_t> fingerprints_of(const Model& model);

/// Where a run goes on.
struct ResumePoint {
  bool is_complete = false;              ///< the run has all frames: nothing is left to do
  bool has_run = false;                  ///< whether the folder has a run
  int frames_written = 0;                ///< of it
  std::optional<Checkpoint> checkpoint;  ///< none: from the beginning
};

/// Throws FileError if the folder has files but no run, if it has the run of another scene, whose differences are named, if its
/// checkpoint cannot be used, or if a run that ended has none: nothing is removed that was meant to stay.
[[nodiscard]] ResumePoint find_resume_point(const OutputFolder& folder, const RunFacts& facts, const Simulator& simulator);

/// Throws FileError if the checkpoint is not that of a run.
[[nodiscard]] RunCheckpoint run_checkpoint(const Checkpoint& checkpoint, const OutputFolder& folder);

[[nodiscard]] std::string bytes_of(const RunCheckpoint& checkpoint);

}  // namespace sprung
