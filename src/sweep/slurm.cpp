#include "sweep/slurm.h"

#include "base/error.h"
#include "sweep/sweep_runs.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace sprung {
namespace {

namespace fs = std::filesystem;

/// A path in an #SBATCH line, in which Slurm replaces nothing.
std::string for_slurm(const fs::path& path) {
  std::string text = "\"";
  for (const char letter : path.string()) {
    if (letter == '"' || letter == '\\') text += '\\';
    if (letter == '%') text += '%';
    text += letter;
  }
  return text + '"';
}

struct Answer {
  bool is_good = false;
  std::string text;  ///< both outputs, without the last end of a line
};

Answer ask(const std::string& command) {
  Answer answer;
  std::FILE* output = ::popen((command + " 2>&1").c_str(), "r");
  if (output == nullptr) return answer;
  for (std::array<char, 256> part{}; std::fgets(part.data(), static_cast<int>(part.size()), output) != nullptr;)
    answer.text += part.data();
  const int status = ::pclose(output);
  answer.is_good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  while (answer.text.ends_with('\n')) answer.text.pop_back();
  return answer;
}

}  // namespace

std::vector<int> tasks_to_do(const SweepFolder& sweep) {
  std::vector<char> has_runs(static_cast<std::size_t>(sweep.settings().array_size), 0);
  for (const int run : runs_to_do(sweep)) has_runs[static_cast<std::size_t>(sweep.task_of(run))] = 1;
  std::vector<int> tasks;
  for (std::size_t task = 0; task < has_runs.size(); ++task) {
    if (has_runs[task] != 0) tasks.push_back(static_cast<int>(task));
  }
  return tasks;
}

std::string array_of(const std::vector<int>& tasks) {
  std::string text;
  for (std::size_t begin = 0; begin < tasks.size();) {
    std::size_t end = begin + 1;
    while (end < tasks.size() && tasks[end] == tasks[end - 1] + 1) ++end;
    if (!text.empty()) text += ',';
    text += std::to_string(tasks[begin]);
    if (end - begin > 1) text += '-' + std::to_string(tasks[end - 1]);
    begin = end;
  }
  return text;
}

std::string slurm_script(const SweepFolder& sweep, const SlurmOptions& options, const std::vector<int>& tasks,
                         const std::string& program) {
  std::ostringstream script;
  const auto line = [&](const std::string& option) { script << "#SBATCH " << option << '\n'; };
  script << "#!/bin/sh\n";
  line("--job-name=sprung-sweep");
  line("--array=" + array_of(tasks));
  line("--cpus-per-task=" + std::to_string(sweep.progress().jobs));
  line("--output=" + for_slurm(sweep.path() / "slurm") + "/task-%a.log");
  line("--open-mode=append");
  // A task whose node failed, or that made room for another job, goes on later.
  line("--requeue");
  // Before the time limit ends the task, its runs get the time for a checkpoint.
  line("--signal=B:TERM@60");
  if (!options.account.empty()) line("--account=" + options.account);
  if (!options.partition.empty()) line("--partition=" + options.partition);
  if (!options.time.empty()) line("--time=" + options.time);
  script << "exec " << shell_word(program) << " sweep --task \"$SLURM_ARRAY_TASK_ID\" --out " << shell_word(sweep.path().string())
         << '\n';
  return script.str();
}

void expect_slurm() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((fs::path(folder) / "sbatch").c_str(), X_OK) == 0) return;
  }
  throw FileError(
      "submit", "the array job",
      "sbatch is not installed; run it where Slurm is, on Debian with apt install slurm-client, or with --engine local");
}

std::string submit(const fs::path& script) {
  const Answer answer = ask("sbatch --parsable " + shell_word(script.string()));
  if (!answer.is_good) throw FileError("submit", script.string(), answer.text.substr(0, answer.text.find('\n')));
  // sbatch may say something before the number, and adds the name of a cluster.
  const std::string last = answer.text.substr(answer.text.find_last_of('\n') + 1);
  return last.substr(0, last.find(';'));
}

bool is_in_queue(const std::string& job) {
  if (job.empty()) return false;
  const Answer answer = ask("squeue --noheader --format=%A --jobs=" + shell_word(job));
  if (answer.is_good) return !answer.text.empty();
  if (answer.text.find("Invalid job id") != std::string::npos) return false;  // it ended so long ago that Slurm forgot it
  throw FileError("ask Slurm for", "job " + job, answer.text.substr(0, answer.text.find('\n')));
}

}  // namespace sprung
