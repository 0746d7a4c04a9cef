#include "viewer/live/live_recording.h"

#include "base/error.h"
#include "base/files/binary_archive.h"
#include "dynamics/state/state_members.h"
#include "output/run_output.h"
#include "scene/run_facts.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

namespace sprung {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFrameBytes = 512'000'000;
constexpr std::size_t kMostStateBytes = 128'000'000;

constexpr const char* kNote =
    "Saved from the viewer: the frames show what the hand pulled and pinned and what was changed on the way, the scene only how it "
    "was at the end.";

std::size_t bytes_of(const OutputFrame& frame) {
  std::size_t doubles = static_cast<std::size_t>(frame.state.positions.size() + frame.state.velocities.size());
  for (const Points& vertices : frame.state.deformed) doubles += static_cast<std::size_t>(vertices.size());
  return sizeof(double) * doubles + frame.state.states.size() + frame.state.broken.size();
}

std::string outcome_of(const std::optional<StepFailure>& failure) {
  return failure ? std::string("diverged: ") + StepError(*failure).what() : "done";
}

}  // namespace

void LiveRecording::begin(const Simulator& simulator, const HandPins& pins) {
  *this = LiveRecording();
  keep(simulator, diagnostics_without_distance(simulator), pins);
}

void LiveRecording::add_step(const Simulator& simulator, const StepReport& report, double step_ms, const HandPins& pins) {
  sums_.add(report);
  ms_ += step_ms;
  if (simulator.state().step_in_frame != 0) return;
  FrameDiagnostics diagnostics = diagnostics_without_distance(simulator);
  std::exchange(sums_, {}).write(simulator.settings().step, diagnostics);
  diagnostics.frame_ms = std::exchange(ms_, 0.0);
  keep(simulator, diagnostics, pins);
}

void LiveRecording::keep(const Simulator& simulator, const FrameDiagnostics& diagnostics, const HandPins& pins) {
  const SimulationState& state = simulator.state();
  // A run that went on without space leaves a gap in which no frame fits any more.
  if (static_cast<std::int64_t>(frames_.size()) == state.frame && frame_bytes_ < kMostFrameBytes) {
    frames_.push_back(output_frame(simulator, diagnostics, frames_.empty() ? RunProgress() : frames_.back().progress, true));
    frame_bytes_ += bytes_of(frames_.back());
  }
  states_.push_back({.frame = state.frame, .time = simulator.time(), .bytes = to_bytes(state), .pins = pins});
  state_bytes_ += states_.back().bytes.size();
  while (state_bytes_ > kMostStateBytes) {
    state_bytes_ -= states_.front().bytes.size();
    states_.pop_front();
  }
}

std::optional<LiveRecording::Past> LiveRecording::state_near(double time) const {
  const auto nearest = std::ranges::min_element(states_, {}, [time](const KeptState& kept) { return std::abs(kept.time - time); });
  if (nearest == states_.end()) return std::nullopt;
  std::optional<Past> past(std::in_place);
  BinaryReader(nearest->bytes).read(past->state);
  past->pins = nearest->pins;
  return past;
}

void LiveRecording::cut_after(std::int64_t frame) {
  while (static_cast<std::int64_t>(frames_.size()) > frame + 1) {
    frame_bytes_ -= bytes_of(frames_.back());
    frames_.pop_back();
  }
  while (!states_.empty() && states_.back().frame > frame) {
    state_bytes_ -= states_.back().bytes.size();
    states_.pop_back();
  }
  sums_ = {};
  ms_ = 0.0;
}

void LiveRecording::save(const fs::path& folder, const LoadedScene& loaded, const std::optional<StepFailure>& failure) const {
  std::error_code reason;
  if (!fs::create_directory(folder, reason)) {
    throw FileError("create the folder", folder.string(), reason ? reason.message() : "it exists");
  }
  try {
    RunFacts facts = facts_of(loaded);
    facts.frames = static_cast<int>(frames_.size());
    facts.warnings.emplace_back(kNote);
    RunOutput output(OutputFolder(folder, false), facts, loaded.simulator);
    for (const OutputFrame& frame : frames_) output.write_frame(frame);
    output.finish(outcome_of(failure));
    loaded.simulator.save(folder / kCheckpointFile);
  } catch (...) {
    fs::remove_all(folder, reason);
    throw;
  }
}

}  // namespace sprung
