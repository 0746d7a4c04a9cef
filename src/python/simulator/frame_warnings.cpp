#include "python/simulator/frame_warnings.h"

#include "simulation/simulator.h"

#include <algorithm>
#include <utility>

namespace sprung::python {
namespace {

// A program has no last frame: so many frames tell whether contact stops particles in many of them.
constexpr int kEnoughFrames = 10;

}  // namespace

void FrameWarnings::note_step(const Simulator& simulator, const StepReport& report) {
  sums_ += report;
  if (simulator.state().step_in_frame != 0) return;
  FrameDiagnostics frame;
  frame.frame = static_cast<int>(simulator.state().frame) + 1;
  frame.inverted_cells = inverted_cells(simulator);
  note_frame(simulator, frame);
}

void FrameWarnings::note_frame(const Simulator& simulator, FrameDiagnostics frame) {
  frame.truncated += sums_.truncated;
  frame.infeasible += sums_.infeasible;
  frame.max_infeasible = std::max(frame.max_infeasible, sums_.max_infeasible);
  frame.substeps += sums_.substeps;
  frame.stretch_excess = std::max(frame.stretch_excess, sums_.stretch_excess);
  sums_ = {};
  sprung::note_frame(simulator, frame, memory_);
  std::array<std::optional<std::string>, kKinds> found{infeasible_warning(frame), inverted_warning(simulator, frame),
                                                       missed_limit_warning(simulator, memory_)};
  if (memory_.frames >= kEnoughFrames) found.back() = thin_bodies_warning(simulator, memory_);
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    if (found[kind] && !(*told_)[kind].exchange(true)) waiting_.push_back(std::move(*found[kind]));
  }
}

std::optional<std::string> FrameWarnings::next() {
  if (waiting_.empty()) return std::nullopt;
  std::string text = std::move(waiting_.front());
  waiting_.erase(waiting_.begin());
  return text;
}

}  // namespace sprung::python
