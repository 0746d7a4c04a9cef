#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "app/run_watch.h"
#include "app/step_text.h"
#include "base/error.h"
#include "base/format.h"
#include "base/parallel.h"
#include "output/run_output.h"
#include "scene/building/strength_scatter.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <optional>
#include <utility>

namespace sprung {
namespace {

RunFacts facts_of(const LoadedScene& loaded, const RunOptions& options, int threads) {
  BodyMaterials materials;
  for (const BodyScene& body : loaded.scene.bodies) {
    if (!body.preset.empty()) materials[body.name] = body.preset;
  }
  return {.scene = loaded.scene.resolved,
          .frame_rate = loaded.scene.frame_rate,
          .frames = loaded.frames,
          .steps_per_frame = loaded.simulator.settings().steps_per_frame,
          .threads = threads,
          .stretch_solver = loaded.simulator.stretch_solver(),
          .seed = uses_seed(loaded.scene) ? std::optional(loaded.scene.settings.seed) : std::nullopt,
          .adjustments = loaded.adjustments,
          .warnings = loaded.warnings,
          .sources = loaded.sources,
          .scene_file = loaded.scene.file.filename().string(),
          .materials = std::move(materials),
          .write_obj = options.format == "obj",
          .write_record = loaded.scene.write_record};
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

// The error that ended the run matters more than a failure to record it.
void finish_without_error(RunOutput& output, const std::string& outcome) {
  try {
    output.finish(outcome);
  } catch (const FileError&) {
    return;
  }
}

/// Nothing if the user interrupts.
std::optional<FrameDiagnostics> next_frame(FrameRunner& runner) {
  try {
    return runner.next_frame();
  } catch (const StoppedError&) {
    return std::nullopt;
  }
}

/// Writes frames until all are written or the user interrupts. `written` counts them, also if an exception ends the run.
void write_frames(LoadedScene& loaded, RunOutput& output, bool quiet, int& written) {
  FrameRunner runner(loaded.simulator);
  Progress progress(loaded.frames, quiet);
  RunWatch watch(loaded.simulator, output, quiet);
  loaded.simulator.stop_when(interrupted);
  for (int frame = 1; frame <= loaded.frames && !interrupted(); ++frame) {
    const auto diagnostics = frame == 1 ? runner.first_frame() : next_frame(runner);
    if (!diagnostics) break;
    output.write_frame(loaded.simulator, *diagnostics);
    written = frame;
    watch.note_frame(*diagnostics);
    progress.frame_done(frame);
  }
  watch.finish();
}

/// Frame 1 is the state at time 0, so it exists when a simulation diverges.
void print_last_frame(const LoadedScene& loaded, int frames, const std::string& folder) {
  print_message(fmt::format("the last frame is {} at {} s; frames 1 to {} are in {}", frames,
                            format_number((frames - 1) / loaded.scene.frame_rate, 6), frames, folder));
}

int write_run(LoadedScene& loaded, RunOutput& output, const RunOptions& options) {
  int frames = 0;
  try {
    write_frames(loaded, output, options.quiet, frames);
    output.finish(frames == loaded.frames ? "done" : "interrupted");
  } catch (const StepError& error) {
    finish_without_error(output, std::string("diverged: ") + error.what());
    print_last_frame(loaded, frames, options.out);
    throw;
  } catch (const std::exception& error) {
    finish_without_error(output, std::string("failed: ") + error.what());
    throw;
  }
  return frames;
}

}  // namespace

ExitCode run(const RunOptions& options) {
  const int threads = thread_count(options.threads);
  const ThreadLimit limit(threads);
  LoadedScene loaded = load_scene(options.scene);
  loaded.frames = options.frames.value_or(loaded.frames);
  if (options.format == "none" && !loaded.scene.write_record) {
    throw UsageError("--format none with \"record\": false writes no frames; leave out one of them");
  }
  if (interrupted()) return ExitCode::interrupted;

  RunOutput output(OutputFolder(options.out, options.overwrite), facts_of(loaded, options, threads), loaded.simulator);
  if (!options.quiet) announce(loaded);
  const auto start = std::chrono::steady_clock::now();
  const int written = write_run(loaded, output, options);
  const std::string time = describe_duration(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());

  if (written < loaded.frames) {
    print_message(fmt::format("interrupted; {} of {} frames are in {}", written, loaded.frames, options.out));
    return ExitCode::interrupted;
  }
  if (!options.quiet) print_message(fmt::format("{} frames in {}, written to {}", written, time, options.out));
  return ExitCode::done;
}

}  // namespace sprung
