#include "sweep/sweep_runs.h"

#include "base/error.h"
#include "base/format.h"
#include "output/folder_lock.h"
#include "output/output_folder.h"
#include "output/run_summary.h"
#include "sweep/process_pool.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

namespace sprung {
namespace {

constexpr int kDone = 0;
constexpr int kInterrupted = 130;
// Wrong usage, files that cannot be used, a program that is gone: no run would do better.
constexpr std::array<int, 3> kFaultsOfAll{2, 5, 127};

constexpr std::chrono::milliseconds kKilledTogether{500};

constexpr const char* kErrorPrefix = "sprung: error: ";

/// The errors of a run, one a line.
std::string errors_in(const std::string& text) {
  std::string errors;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(kErrorPrefix)) continue;
    if (!errors.empty()) errors += '\n';
    errors += line.substr(std::strlen(kErrorPrefix));
  }
  return errors;
}

std::string message_of(const ProcessEnd& end) {
  if (end.signal != 0) return "ended by signal " + std::to_string(end.signal) + " (" + ::strsignal(end.signal) + ")";
  const std::string errors = errors_in(end.errors);
  return errors.empty() ? "ended with exit code " + std::to_string(end.exit_code) : errors;
}

/// Whether a run may go on: from a checkpoint, or because it is complete. One that ended otherwise begins again.
bool can_go_on(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::exists(folder / kCheckpointFile, ignored)) return true;
  const auto run = written_run(folder / kRunSummaryFile);
  return run && run->outcome == "done";
}

/// Writes manifest.json and results.csv so seldom that it takes at most a twentieth of the time.
class ManifestKeeper {
 public:
  explicit ManifestKeeper(const SweepFolder& sweep) : sweep_(sweep) {}

  void write_if_due() {
    if (Clock::now() >= due_) write_now();
  }

  void write_now() {
    const auto start = Clock::now();
    sweep_.write_manifest();
    sweep_.write_results();
    const auto end = Clock::now();
    constexpr int kShare = 20;
    due_ = end + std::max<Clock::duration>(std::chrono::seconds(1), kShare * (end - start));
  }

 private:
  using Clock = std::chrono::steady_clock;
  const SweepFolder& sweep_;
  Clock::time_point due_ = Clock::now();
};

}  // namespace

std::vector<int> runs_to_do(const SweepFolder& sweep, int task) {
  std::vector<int> runs;
  for (int run = 1; run <= sweep.plan().run_count(); ++run) {
    const RunStatus status = sweep.state(run).status;
    if (status == RunStatus::done || status == RunStatus::failed) continue;
    if (task < 0 || sweep.task_of(run) == task) runs.push_back(run);
  }
  return runs;
}

void forget_failed_runs(SweepFolder& sweep) {
  for (int run = 1; run <= sweep.plan().run_count(); ++run) {
    if (sweep.state(run).status != RunStatus::failed) continue;
    // Its output goes first: a kill between the two leaves a failed run, and never a run that goes on from a failure.
    if (std::filesystem::exists(sweep.run_folder(run))) const OutputFolder emptied(sweep.run_folder(run), true);
    sweep.note(run, {});
  }
}

std::vector<std::string> command_of(const SweepFolder& sweep, int run, const std::string& program) {
  const SweepSettings& settings = sweep.settings();
  std::string formats;
  for (const std::string& format : settings.formats) formats += (formats.empty() ? "" : ",") + format;
  std::vector<std::string> words{program,
                                 "run",
                                 settings.scene.file,
                                 "--out",
                                 sweep.run_folder(run).string(),
                                 can_go_on(sweep.run_folder(run)) ? "--resume" : "--overwrite",
                                 "--quiet",
                                 "--threads",
                                 "1",
                                 "--format",
                                 formats,
                                 "--checkpoint",
                                 format_number(sweep.progress().checkpoint)};
  const auto add = [&](const std::string& option, const std::string& value) {
    words.push_back(option);
    words.push_back(value);
  };
  if (settings.frames) add("--frames", std::to_string(*settings.frames));
  for (const std::string& folder : settings.scene.mesh_paths) add("--mesh-path", folder);
  if (formats == "none") add("--set", "output.record=false");
  for (const std::string& change : settings.scene.overrides) add("--set", change);
  for (const std::string& change : overrides_of(sweep.plan(), run)) add("--set", change);
  return words;
}

bool run_sweep(SweepFolder& sweep, const std::vector<int>& runs, const SweepWork& work) {
  ManifestKeeper manifest(sweep);
  std::optional<std::string> fault;
  std::set<int> tried_again;
  bool was_interrupted = false;
  const bool writes_nothing = sweep.settings().formats == std::vector<std::string>{"none"};
  const auto note_end = [&](int run, const ProcessEnd& end) {
    // Whoever kills this process too, as Slurm does, may kill the run first: then the run did not fail.
    if (end.signal == SIGKILL) std::this_thread::sleep_for(kKilledTogether);
    const bool is_interrupted = end.exit_code == kInterrupted || end.signal == SIGTERM;
    const bool is_fault = std::ranges::find(kFaultsOfAll, end.exit_code) != kFaultsOfAll.end();
    if (is_interrupted || is_fault) {
      sweep.mark_pending(run);
      // A process of a killed sweep may have been faster, and may have ended since.
      if (is_fault && (is_locked(sweep.run_folder(run)) || tried_again.insert(run).second)) return true;
      was_interrupted |= is_interrupted;
      if (is_fault && !fault) fault = "run " + run_name(run) + ": " + message_of(end);
      return false;
    }
    const bool is_done = end.exit_code == kDone;
    RunResult result = result_of_run(sweep.run_folder(run));
    sweep.note(run, {.status = is_done ? RunStatus::done : RunStatus::failed,
                     .exit_code = end.exit_code,
                     .seconds = end.seconds,
                     .message = is_done ? "" : message_of(end),
                     .columns = std::move(result.columns),
                     .row = std::move(result.row)});
    // It is for going on, which a run that is done never does.
    std::error_code ignored;
    if (is_done && writes_nothing) std::filesystem::remove(sweep.run_folder(run) / kCheckpointFile, ignored);
    work.report(run);
    return false;
  };
  {
    ProcessPool pool(sweep.progress().jobs, {.command =
                                                 [&](int run) {
                                                   work.check_scene();
                                                   return command_of(sweep, run, work.program);
                                                 },
                                             .folder = [&](int run) { return sweep.run_folder(run); },
                                             .started = [&](int run) { sweep.mark_running(run); },
                                             .ended = note_end,
                                             .tick =
                                                 [&] {
                                                   if (work.keeps_manifest) manifest.write_if_due();
                                                 },
                                             .stop = [&] { return fault.has_value() || work.is_interrupted(); }});
    pool.run(runs);
  }
  if (fault && work.keeps_manifest) manifest.write_now();
  if (fault) throw FileError("go on with the sweep", sweep.path().string(), *fault);
  return !was_interrupted && !work.is_interrupted();
}

std::string shell_word(const std::string& text) {
  const auto is_plain = [](unsigned char letter) {
    return std::isalnum(letter) != 0 || std::string_view("_-./=:,+@%").find(static_cast<char>(letter)) != std::string_view::npos;
  };
  if (!text.empty() && std::ranges::all_of(text, is_plain)) return text;
  std::string word = "'";
  for (const char letter : text) word += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return word + "'";
}

double seconds_left(const RunCounts& counts, int jobs) {
  return counts.mean_seconds * (counts.running + counts.pending) / std::max(jobs, 1);
}

}  // namespace sprung
