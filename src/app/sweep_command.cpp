#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "app/text/mesh_text.h"
#include "base/error.h"
#include "base/files/file_writer.h"
#include "base/files/text_encoding.h"
#include "base/format.h"
#include "base/parallel.h"
#include "output/folder_lock.h"
#include "sweep/slurm.h"
#include "sweep/sweep_check.h"
#include "sweep/sweep_folder.h"
#include "sweep/sweep_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace sprung {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::string_view kStandardInput = "-";

/// This program.
std::string own_path() {
  std::error_code error;
  const fs::path path = fs::read_symlink("/proc/self/exe", error);
  if (error) throw FileError("find", "the program sprung", error.message());
  return path.string();
}

SceneSource absolute(SceneSource source) {
  source.file = fs::absolute(source.file).lexically_normal().string();
  for (std::string& folder : source.mesh_paths) folder = fs::absolute(folder).lexically_normal().string();
  return source;
}

/// A scene of standard input belongs to the folder of its sweep, where it is written once the sweep begins.
SceneSource scene_of(const SweepOptions& options, const fs::path& folder) {
  if (options.scene.file != kStandardInput) return absolute(options.scene);
  SceneSource source = options.scene;
  source.text = utf8_text(std::string(std::istreambuf_iterator<char>(std::cin), {}));
  source.file = (folder / "scene.json").string();
  return absolute(source);
}

SweepFolder planned(const SweepOptions& options) {
  const fs::path folder = fs::absolute(options.out).lexically_normal();
  SweepSettings settings{.scene = scene_of(options, folder),
                         .request = options.request,
                         .formats = options.formats,
                         .frames = options.frames,
                         .engine = options.engine,
                         .array_size = options.array_size.value_or(0)};
  settings.first_scene = checked_scene(settings.scene, options.request);
  SweepFolder sweep(folder, std::move(settings));
  sweep.progress().jobs = options.engine == "slurm" ? options.jobs.value_or(1) : thread_count(options.jobs);
  sweep.progress().checkpoint = options.checkpoint;
  return sweep;
}

/// How many runs proceed at the same time, as far as one can know.
int parallel_runs(const SweepFolder& sweep, const RunCounts& counts) {
  return sweep.settings().engine == "slurm" ? std::max(counts.running, 1) : sweep.progress().jobs;
}

std::string describe(const RunCounts& counts, int jobs) {
  std::string text =
      fmt::format("{} done, {} failed, {} running, {} pending", counts.done, counts.failed, counts.running, counts.pending);
  const double left = seconds_left(counts, jobs);
  if (left > 0.0) text += fmt::format("; about {} left", describe_duration(left));
  return text;
}

/// Says what ended: failures at once, the rest now and then.
class SweepProgressLines {
 public:
  SweepProgressLines(const SweepFolder& sweep, bool quiet) : sweep_(sweep), quiet_(quiet) {}

  void note_end(int run) {
    const RunState& state = sweep_.state(run);
    if (state.status == RunStatus::failed) print_error("run " + run_name(run) + ": " + state.message);
    constexpr std::chrono::seconds kInterval{10};
    if (quiet_ || Clock::now() < shown_ + kInterval) return;
    shown_ = Clock::now();
    print_message(describe(sweep_.counts(), sweep_.progress().jobs));
  }

 private:
  const SweepFolder& sweep_;
  bool quiet_;
  Clock::time_point shown_ = Clock::now();
};

void write_state(const SweepFolder& sweep) {
  sweep.write_manifest();
  sweep.write_results();
}

ExitCode code_of(const RunCounts& counts) { return counts.failed > 0 ? ExitCode::diverged : ExitCode::done; }

ExitCode run_here(SweepFolder& sweep, const SweepOptions& options) {
  const auto start = Clock::now();
  SweepProgressLines lines(sweep, options.quiet);
  const std::vector<int> runs = runs_to_do(sweep);
  if (!options.quiet) {
    print_message(fmt::format("{} of {} to do, {} at a time, into {}", runs.size(),
                              counted(static_cast<std::size_t>(sweep.plan().run_count()), "run"), sweep.progress().jobs,
                              options.out));
  }
  SceneWatch scene(sweep);
  const bool is_whole = run_sweep(sweep, runs,
                                  {.program = own_path(),
                                   .is_interrupted = interrupted,
                                   .check_scene = [&] { scene.check(); },
                                   .report = [&](int run) { lines.note_end(run); }});
  write_state(sweep);
  const RunCounts counts = sweep.counts();
  const std::string time = describe_duration(std::chrono::duration<double>(Clock::now() - start).count());
  if (!is_whole) {
    print_message(fmt::format("interrupted; {} done, {} failed, {} to do; the same command goes on", counts.done, counts.failed,
                              counts.pending));
    return ExitCode::interrupted;
  }
  if (!options.quiet) {
    print_message(fmt::format("{} done, {} failed, in {}; {} has a line for each", counts.done, counts.failed, time,
                              (fs::path(options.out) / kResultsFile).string()));
    if (counts.failed > 0) print_message("failed runs are not tried again; --retry-failed does");
  }
  return code_of(counts);
}

ExitCode submit_to_slurm(SweepFolder& sweep, const SweepOptions& options) {
  const std::vector<int> tasks = tasks_to_do(sweep);
  if (tasks.empty()) {
    write_state(sweep);
    print_message("nothing is left to do: " + describe(sweep.counts(), 1));
    return code_of(sweep.counts());
  }
  const fs::path script = sweep.path() / "slurm" / "sweep.sh";
  write_file(script, slurm_script(sweep, options.slurm, tasks, own_path()));
  sweep.progress().job = submit(script);
  sweep.write_manifest();
  if (!options.quiet) {
    print_message(fmt::format("job {} does {} in {}; sprung sweep --status {} tells how far it is", sweep.progress().job,
                              counted(runs_to_do(sweep).size(), "run"), counted(tasks.size(), "task"), options.out));
  }
  return ExitCode::done;
}

/// The script, or the commands of the runs that are left to do.
ExitCode show_work(SweepFolder& sweep, const SweepOptions& options) {
  sweep.read_journals();
  if (options.engine == "slurm") {
    print_result(slurm_script(sweep, options.slurm, tasks_to_do(sweep), own_path()));
    return ExitCode::done;
  }
  for (const int run : runs_to_do(sweep)) {
    std::vector<std::string> words = command_of(sweep, run, "sprung");
    for (std::string& word : words) word = shell_word(word);
    print_result(fmt::format("{}\n", fmt::join(words, " ")));
  }
  return ExitCode::done;
}

/// Requires that the folder exists.
ExitCode work_in_folder(SweepFolder& sweep, const SweepOptions& options) {
  const bool on_slurm = options.engine == "slurm";
  const FolderLock lock(sweep.path());
  sweep.check_is_same_or_free();  // another one may have begun here meanwhile
  if (has_sweep(sweep.path())) {
    sweep.progress().job = SweepFolder(sweep.path()).progress().job;
    sweep.read_journals();
  }
  if (on_slurm && is_in_queue(sweep.progress().job)) {
    throw FileError("submit", "the array job",
                    fmt::format("job {} of this sweep is still in the queue; wait for it, or end it with scancel {}",
                                sweep.progress().job, sweep.progress().job));
  }
  if (options.retry_failed) forget_failed_runs(sweep);
  sweep.write_manifest();
  const SceneSource& scene = sweep.settings().scene;
  if (scene.text && !fs::exists(scene.file)) write_file(scene.file, *scene.text);
  return on_slurm ? submit_to_slurm(sweep, options) : run_here(sweep, options);
}

ExitCode begin_or_go_on(const SweepOptions& options) {
  SweepFolder sweep = planned(options);
  sweep.check_is_same_or_free();
  if (options.dry_run) return show_work(sweep, options);
  if (options.engine == "slurm") expect_slurm();
  if (!has_sweep(sweep.path())) check_meshes_and_bodies(sweep);
  if (interrupted()) return ExitCode::interrupted;
  const bool is_new = !fs::exists(sweep.path());
  make_folder(sweep.path());
  try {
    return work_in_folder(sweep, options);
  } catch (...) {
    std::error_code not_empty;
    if (is_new) fs::remove(sweep.path(), not_empty);
    throw;
  }
}

/// Brings manifest.json and results.csv up to date, unless another process is doing so.
void refresh(SweepFolder& sweep) try {
  if (is_locked(sweep.path())) return;
  const FolderLock lock(sweep.path());
  sweep = SweepFolder(sweep.path());
  write_state(sweep);
} catch (const FileError& error) {
  print_warning(error.what());
}

/// Waits for the processes of a former start of the task, which may still end.
std::optional<FolderLock> lock_task(const fs::path& folder) {
  constexpr std::chrono::milliseconds kInterval{200};
  make_folder(folder);
  while (!interrupted()) {
    if (!is_locked(folder)) return std::optional<FolderLock>(std::in_place, folder);
    std::this_thread::sleep_for(kInterval);
  }
  return std::nullopt;
}

ExitCode do_task(const SweepOptions& options) {
  SweepFolder sweep(fs::absolute(options.out).lexically_normal());
  const auto lock = lock_task(sweep.path() / "slurm" / fmt::format("task-{}", *options.task));
  if (!lock) return ExitCode::interrupted;
  sweep.read_journals();
  SceneWatch scene(sweep);
  SweepProgressLines lines(sweep, false);
  const bool is_whole = run_sweep(sweep, runs_to_do(sweep, *options.task),
                                  {.program = own_path(),
                                   .keeps_manifest = false,
                                   .is_interrupted = interrupted,
                                   .check_scene = [&] { scene.check(); },
                                   .report = [&](int run) { lines.note_end(run); }});
  refresh(sweep);
  return is_whole ? ExitCode::done : ExitCode::interrupted;
}

/// A folder that is locked has a run in it.
int running_now(const SweepFolder& sweep) {
  const std::vector<int> runs = runs_to_do(sweep);
  return static_cast<int>(std::ranges::count_if(runs, [&](int run) { return is_locked(sweep.run_folder(run)); }));
}

ExitCode print_status(const SweepOptions& options) {
  SweepFolder sweep(options.status);
  refresh(sweep);
  RunCounts counts = sweep.counts();
  counts.running = running_now(sweep);
  counts.pending -= counts.running;
  const int runs = sweep.plan().run_count();
  std::string text = text_row("sweep", options.status) +
                     text_row("runs", fmt::format("{}: {}", runs, describe(counts, parallel_runs(sweep, counts))));
  if (counts.mean_seconds > 0.0)
    text += text_row("time", fmt::format("{} s a run on average", format_number(counts.mean_seconds, 3)));
  if (!sweep.progress().job.empty()) text += text_row("job", sweep.progress().job + " of Slurm");
  constexpr int kMostFailures = 20;
  int shown = 0;
  for (int run = 1; run <= runs && shown < kMostFailures; ++run) {
    const RunState& state = sweep.state(run);
    if (state.status != RunStatus::failed) continue;
    ++shown;
    text += text_row("failed", fmt::format("{}: {}", run_name(run), state.message.substr(0, state.message.find('\n'))));
  }
  if (counts.failed > shown) text += text_row("", fmt::format("and {} more, in {}", counts.failed - shown, kManifestFile));
  print_result(text);
  return ExitCode::done;
}

}  // namespace

ExitCode sweep(const SweepOptions& options) {
  if (!options.status.empty()) return print_status(options);
  return options.task ? do_task(options) : begin_or_go_on(options);
}

}  // namespace sprung
