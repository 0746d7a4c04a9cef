#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "app/run_watch.h"
#include "app/text/step_text.h"
#include "base/error.h"
#include "base/format.h"
#include "base/parallel.h"
#include "output/exporters/exporter.h"
#include "output/run_output.h"
#include "output/run_summary.h"
#include "scene/run_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sprung {
namespace {

constexpr const char* kNoFormat = "none";
constexpr const char* kHtml = "html";

using Formats = std::vector<std::string>;

bool has(const Formats& formats, const std::string& format) { return std::ranges::find(formats, format) != formats.end(); }

/// As asked for; else those of the run that is resumed.
Formats formats_of(const RunOptions& options) {
  if (!options.formats.empty()) return options.formats;
  const auto run = options.resume ? written_run(std::filesystem::path(options.out) / kRunSummaryFile) : std::nullopt;
  if (!run) return {"obj"};
  return run->formats.empty() ? Formats{kNoFormat} : run->formats;
}

/// Those that exporters make.
Formats exporters_among(const Formats& formats) {
  Formats made;
  std::ranges::copy_if(exporter_formats(), std::back_inserter(made), [&](const auto& format) { return has(formats, format); });
  return made;
}

/// Throws UsageError if they do not go together.
void check_formats(const Formats& formats, bool writes_record) {
  if (has(formats, kNoFormat) && formats.size() > 1) throw UsageError("--format none goes with no other format; leave it out");
  if (writes_record) return;
  for (const std::string& format : exporters_among(formats)) {
    if (make_exporter(format, {})->writes_each_frame()) continue;
    throw UsageError(fmt::format("--format {} is made from record.bin at the end of the run; leave out \"record\": false", format));
  }
}

RunFacts facts_of(const LoadedScene& loaded, const RunOptions& options, const Formats& formats, int threads) {
  RunFacts facts = facts_of(loaded);
  facts.threads = threads;
  facts.write_record = loaded.scene.write_record;
  facts.formats = exporters_among(formats);
  if (has(formats, kHtml)) facts.later_formats = {kHtml};
  facts.checkpoint_interval = options.checkpoint;
  return facts;
}

void announce(const LoadedScene& loaded) {
  const SpringNetwork& network = loaded.simulator.network();
  const std::size_t obstacles = loaded.simulator.obstacles().size();
  print_message(fmt::format("{}: {} of {}, {}, {}, {}", loaded.scene.file.string(), counted(loaded.frames, "frame"),
                            describe_steps(loaded), counted(network.particle_count(), "particle"),
                            counted(network.springs.count(), "spring"), counted(obstacles, "obstacle")));
  for (const StepAdjustment& adjustment : loaded.adjustments) print_message(describe(adjustment));
  for (const std::string& note : loaded.simulator.notes()) print_message(note);
  for (const std::string& warning : loaded.warnings) print_warning(warning);
}

// An interrupt waits so long [s] for the end of the frame, from which the run then can go on. Whoever ends a program mostly gives
// it 10 s. Each frame that takes longer gets a checkpoint.
constexpr double kPatience = 5.0;

/// Whether an interrupt has waited long enough.
class OutOfPatience {
 public:
  bool operator()() {
    if (!interrupted()) return false;
    if (!since_) since_ = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - *since_).count() > kPatience;
  }

 private:
  std::optional<std::chrono::steady_clock::time_point> since_;
};

/// Nothing if the user interrupts.
std::optional<FrameDiagnostics> next_frame(FrameRunner& runner) {
  try {
    return runner.next_frame();
  } catch (const StoppedError&) {
    return std::nullopt;
  }
}

/// The run that is being written.
struct Run {
  LoadedScene& loaded;
  RunOutput& output;
  RunWatch watch;
  bool can_write_checkpoints = true;
};

void note_failed_checkpoint(Run& run, const std::string& failure) {
  if (failure.empty() || !std::exchange(run.can_write_checkpoints, false)) return;
  run.watch.warn(failure + "; the former checkpoint stays, and the run goes on");
}

/// Writes frames until all are written or the user interrupts.
void write_frames(Run& run, bool quiet) {
  FrameRunner runner(run.loaded.simulator);
  Progress progress(run.loaded.frames, run.output.frames_written(), quiet);
  run.loaded.simulator.stop_when(OutOfPatience());
  bool is_whole = true;  // else the simulator stopped within a frame, and a run cannot go on from there
  for (int frame = run.output.frames_written() + 1; frame <= run.loaded.frames && !interrupted(); ++frame) {
    const auto diagnostics = frame == 1 ? runner.first_frame() : next_frame(runner);
    is_whole = diagnostics.has_value();
    if (!is_whole) break;
    run.output.write_frame(run.loaded.simulator, *diagnostics);
    run.watch.note_frame(*diagnostics);
    const auto write =
        diagnostics->frame_ms > 1e3 * kPatience ? &RunOutput::write_checkpoint_now : &RunOutput::write_due_checkpoint;
    note_failed_checkpoint(run, (run.output.*write)(run.loaded.simulator, run.watch.memory()));
    progress.frame_done(frame);
  }
  if (is_whole) note_failed_checkpoint(run, run.output.write_checkpoint_now(run.loaded.simulator, run.watch.memory()));
  run.watch.finish();
}

/// Frame 1 is the state at time 0, so it exists when a simulation diverges.
void print_last_frame(const LoadedScene& loaded, int frames, const std::string& folder) {
  print_message(fmt::format("the last frame is {} at {} s; frames 1 to {} are in {}", frames,
                            format_number((frames - 1) / loaded.scene.frame_rate, 6), frames, folder));
}

void write_run(Run& run, const RunOptions& options) {
  // The error that ended the run matters more than a failure to record it. A failure says that frames are missing, once; what is
  // left to write then is the outcome.
  const auto finish_without_error = [&](const std::string& outcome) {
    for (const std::string& text : {outcome, "failed: " + outcome}) {
      try {
        run.output.finish(text);
        return;
      } catch (const std::exception& error) {
        print_warning(error.what());
      }
    }
  };
  try {
    write_frames(run, options.quiet);
    run.output.finish(run.output.frames_written() == run.loaded.frames ? "done" : "interrupted");
  } catch (const StepError& error) {
    finish_without_error(std::string("diverged: ") + error.what());
    print_last_frame(run.loaded, run.output.frames_written(), options.out);
    throw;
  } catch (const std::exception& error) {
    finish_without_error(std::string("failed: ") + error.what());
    throw;
  }
}

/// The output of a run that begins, or goes on from `point`. `memory` gets what the watch of a run that goes on remembers.
std::unique_ptr<RunOutput> open_output(OutputFolder folder, const RunFacts& facts, const ResumePoint& point, LoadedScene& loaded,
                                       std::string& memory) {
  if (point.checkpoint) {
    auto output = std::make_unique<RunOutput>(std::move(folder), facts, loaded.simulator, *point.checkpoint, memory);
    loaded.simulator.restore(*point.checkpoint);
    return output;
  }
  if (point.has_run) folder.remove_run();
  return std::make_unique<RunOutput>(std::move(folder), facts, loaded.simulator);
}

}  // namespace

ExitCode run(const RunOptions& options) {
  const int threads = thread_count(options.threads);
  const ThreadLimit limit(threads);
  LoadedScene loaded = load_scene(options.scene);
  loaded.frames = options.frames.value_or(loaded.frames);
  const Formats formats = formats_of(options);
  check_formats(formats, loaded.scene.write_record);
  std::error_code ignored;
  if (!loaded.initial_state.empty() && std::filesystem::equivalent(loaded.initial_state, options.out, ignored)) {
    throw FileError("write into the folder", options.out, "the scene begins from the run in it; choose another folder");
  }
  if (interrupted()) return ExitCode::interrupted;

  OutputFolder folder = options.resume ? OutputFolder::as_it_is(options.out) : OutputFolder(options.out, options.overwrite);
  const RunFacts facts = facts_of(loaded, options, formats, threads);
  const ResumePoint point = options.resume ? find_resume_point(folder, facts, loaded.simulator) : ResumePoint();
  if (point.is_complete) {
    print_message(
        fmt::format("{} has {} of the {} that are asked for; nothing is left to do (sprung export writes further formats)",
                    options.out, counted(point.frames_written, "frame"), loaded.frames));
    return ExitCode::done;
  }
  std::string memory;
  const std::unique_ptr<RunOutput> opened = open_output(std::move(folder), facts, point, loaded, memory);
  RunOutput& output = *opened;
  if (!options.quiet) {
    announce(loaded);
    const bool tears = std::ranges::any_of(loaded.simulator.network().springs.laws, &SpringLaw::breaks);
    for (const std::string& loss : output.losses(tears)) print_message(loss);
  }
  Run run{loaded, output, RunWatch(loaded.simulator, output, options.quiet)};
  if (!memory.empty()) run.watch.restore(memory);
  const int begin = output.frames_written();
  if (options.resume && !options.quiet) {
    print_message(begin > 0 ? fmt::format("goes on after frame {} of {}", begin, loaded.frames)
                            : std::string("there is no checkpoint; the run begins at frame 1"));
  }
  const auto start = std::chrono::steady_clock::now();
  write_run(run, options);
  const std::string time = describe_duration(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());

  const int written = output.frames_written();
  if (has(formats, kHtml) && written > 0) export_html(options.out, std::filesystem::path(options.out) / kAnimationFile);
  if (written < loaded.frames) {
    print_message(fmt::format("interrupted; {} of {} frames are in {}{}", written, loaded.frames, options.out,
                              options.checkpoint > 0.0 ? "; --resume goes on" : ""));
    return ExitCode::interrupted;
  }
  if (!options.quiet) print_message(fmt::format("{} frames in {}, written to {}", written - begin, time, options.out));
  return ExitCode::done;
}

}  // namespace sprung
