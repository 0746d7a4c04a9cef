// Array jobs of Slurm, by its commands sbatch and squeue.
#pragma once

#include "sweep/sweep_folder.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// Passed to Slurm as they are; empty: Slurm's default.
struct SlurmOptions {
  std::string account{};
  std::string partition{};
  std::string time{};  ///< limit of a task
};

/// The tasks of which runs are left to do, ascending.
[[nodiscard]] std::vector<int> tasks_to_do(const SweepFolder& sweep);

/// `0-2,5`. Requires ascending numbers.
[[nodiscard]] std::string array_of(const std::vector<int>& tasks);

/// The script of an array job with these tasks. Each task does all of its runs, so that Slurm schedules few tasks and not many
/// short runs. A task that is killed is queued again by Slurm and goes on.
[[nodiscard]] std::string slurm_script(const SweepFolder& sweep, const SlurmOptions& options, const std::vector<int>& tasks,
                                       const std::string& program);

/// Throws FileError unless sbatch can be started.
void expect_slurm();

/// Returns the number of the job. Throws FileError with what sbatch said.
[[nodiscard]] std::string submit(const std::filesystem::path& script);

/// Whether Slurm still has tasks of the job waiting or running. Throws FileError if Slurm does not answer.
[[nodiscard]] bool is_in_queue(const std::string& job);

}  // namespace sprung
