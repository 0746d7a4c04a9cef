#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/load_scene.h"
#include "app/progress.h"
#include "base/error.h"
#include "base/format.h"
#include "base/parallel.h"
#include "output/run_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <thread>

namespace sprung {
namespace {

int thread_count(const RunOptions& options) {
  return options.threads.value_or(std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
}

RunFacts facts_of(const LoadedScene& loaded, int threads) {
  return {.scene = loaded.scene.resolved,
          .frame_rate = loaded.scene.frame_rate,
          .frames = loaded.frames,
          .steps_per_frame = loaded.steps_per_frame,
          .threads = threads,
          .stretch_solver = loaded.simulator.stretch_solver(),
          .warnings = loaded.warnings};
}

void announce(const LoadedScene& loaded) {
  const SpringNetwork& network = loaded.simulator.network();
  const std::size_t obstacles = loaded.simulator.environment().obstacles().size();
  print_message(fmt::format("{}: {} {} of {}, {} particles, {} springs, {} {}", loaded.scene.file.string(), loaded.frames,
                            loaded.frames == 1 ? "frame" : "frames", describe_steps(loaded), network.particle_count(),
                            network.springs.count(), obstacles, obstacles == 1 ? "obstacle" : "obstacles"));
  for (const std::string& warning : loaded.warnings) print_warning(warning);
}

// The error that ends the run matters more than one in telling of it.
void finish_quietly(RunOutput& output, const std::string& outcome) {
  try {
    output.finish(outcome);
  } catch (const FileError&) {
    return;
  }
}

/// Tells once, as it happens, that particles had to yield: contact could not keep them outside of all obstacles.
void warn_of_squeezing(const FrameDiagnostics& frame, RunOutput& output, bool& warned) {
  if (warned || frame.squeezed == 0) return;
  warned = true;
  const std::string warning = fmt::format(
      "frame {}: particles found no free place between obstacles, pins and each other {} times and may cross them; the column "
      "squeezed of diagnostics.csv counts them",
      frame.frame, frame.squeezed);
  output.add_warning(warning);
  print_warning(warning);
}

/// Tells, as it happens, that a body was handed over to another solver of the stretch limit.
class Handovers {
 public:
  explicit Handovers(bool quiet) : quiet_(quiet) {}

  void see(const Simulator& simulator) {
    const std::vector<StretchHold>& holds = simulator.state().stretch_holds;
    told_.resize(holds.size(), false);
    for (std::size_t b = 0; b < holds.size(); ++b) {
      if (quiet_ || told_[b] || !holds[b].solved_since) continue;
      told_[b] = true;
      print_message(fmt::format("passes kept missing the stretch limit of \"{}\"; newton holds it after step {}",
                                simulator.network().bodies[b].name, *holds[b].solved_since));
    }
  }

 private:
  bool quiet_;
  std::vector<bool> told_;
};

/// Remembers by how much the stretch limit was missed, to be told once.
class MissedLimit {
 public:
  explicit MissedLimit(const Simulator& simulator) {
    if (const auto& limit = simulator.settings().stretch_limit) tolerance_ = limit->tolerance;
  }

  void see(const FrameDiagnostics& frame) {
    if (frame.stretch_excess <= tolerance_) return;
    ++frames_;
    if (frame.stretch_excess <= most_) return;
    most_ = frame.stretch_excess;
    worst_frame_ = frame.frame;
  }

  void tell(RunOutput& output) const {
    if (frames_ == 0) return;
    const std::string warning = fmt::format(
        "the stretch limit was missed by more than its tolerance in {} {}, by at most {} % of a rest length in frame {}; the "
        "column stretch_excess of diagnostics.csv tells by how much in each",
        frames_, frames_ == 1 ? "frame" : "frames", format_number(100.0 * most_, 2), worst_frame_);
    output.add_warning(warning);
    print_warning(warning);
  }

 private:
  double tolerance_ = 0.0;
  double most_ = 0.0;
  int frames_ = 0;
  int worst_frame_ = 0;
};

/// Writes frames until all are done or the user interrupts; `written` counts them.
void write_frames(LoadedScene& loaded, RunOutput& output, bool quiet, int& written) {
  FrameRunner runner(loaded.simulator, loaded.steps_per_frame);
  Progress progress(loaded.frames, quiet);
  bool warned = false;
  MissedLimit missed(loaded.simulator);
  Handovers handovers(quiet);
  for (int frame = 1;; ++frame) {
    const FrameDiagnostics diagnostics = frame == 1 ? runner.first_frame() : runner.next_frame();
    output.write_frame(loaded.simulator, diagnostics);
    written = frame;
    warn_of_squeezing(diagnostics, output, warned);
    missed.see(diagnostics);
    handovers.see(loaded.simulator);
    progress.frame_done(frame);
    if (frame < loaded.frames && !interrupted()) continue;
    missed.tell(output);
    return;
  }
}

/// A simulation cannot diverge before its first frame, which is the state at time 0.
void tell_last_good_frame(const LoadedScene& loaded, int frames, const std::string& folder) {
  print_message(fmt::format("the last good frame is {}, at {} s; it and those before are kept in {}", frames,
                            format_number((frames - 1) / loaded.scene.frame_rate, 6), folder));
}

int write_run(LoadedScene& loaded, RunOutput& output, const RunOptions& options) {
  int frames = 0;
  try {
    write_frames(loaded, output, options.quiet, frames);
    output.finish(frames == loaded.frames ? "done" : "interrupted");
  } catch (const StepError& error) {
    finish_quietly(output, std::string("diverged: ") + error.what());
    tell_last_good_frame(loaded, frames, options.out);
    throw;
  } catch (const std::exception& error) {
    finish_quietly(output, std::string("failed: ") + error.what());
    throw;
  }
  return frames;
}

}  // namespace

ExitCode run(const RunOptions& options) {
  const int threads = thread_count(options);
  const ThreadLimit limit(threads);
  LoadedScene loaded = load_scene(options.scene);
  loaded.frames = options.frames.value_or(loaded.frames);
  if (interrupted()) return ExitCode::interrupted;

  RunOutput output(OutputFolder(options.out, options.overwrite), facts_of(loaded, threads), loaded.simulator);
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
