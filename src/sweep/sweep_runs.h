// Runs what a sweep has left to do, each run as a process of the program.
#pragma once

#include "sweep/sweep_folder.h"

#include <functional>
#include <string>
#include <vector>

namespace sprung {

struct SweepWork {
  std::string program;         ///< path of sprung
  bool keeps_manifest = true;  ///< whether this process holds the lock of the folder and writes manifest.json
  std::function<bool()> is_interrupted{};
  std::function<void()> check_scene{};    ///< is called before each run; throws if the scene is no longer that of the sweep
  std::function<void(int run)> report{};  ///< is called after each run that ended
};

/// The runs that are not done, nor failed; `task` -1: of all tasks.
[[nodiscard]] std::vector<int> runs_to_do(const SweepFolder& sweep, int task = -1);

/// Removes the output of failed runs, so that they are to do. Throws FileError.
void forget_failed_runs(SweepFolder& sweep);

/// Runs them. Returns false if it was interrupted; what was running then goes on from its checkpoint another time. Throws FileError
/// if a journal cannot be written, what `check_scene` throws, or FileError with the error of a run that could not read its scene or
/// write its output, which is no fault of its values: it stays to do.
[[nodiscard]] bool run_sweep(SweepFolder& sweep, const std::vector<int>& runs, const SweepWork& work);

/// The command of a run.
[[nodiscard]] std::vector<std::string> command_of(const SweepFolder& sweep, int run, const std::string& program);

/// One word for a shell, in quotes if it needs them.
[[nodiscard]] std::string shell_word(const std::string& text);

/// The time that is left [s], by the mean of the runs that ended; 0 if none has.
[[nodiscard]] double seconds_left(const RunCounts& counts, int jobs);

}  // namespace sprung
