// What a simulator warns of while it steps.
#pragma once

#include "simulation/frame_watch.h"
#include "simulation/step/step_report.h"

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprung::python {

/// The warnings of `sprung run` about frames. A copy shares what was warned of, so that each comes once for all simulators of a
/// scene. Copies may be used by several threads.
class FrameWarnings {
 public:
  /// Call it after each step. Looks at the sums at the end of a frame.
  void note_step(const Simulator& simulator, const StepReport& report);

  /// Call it instead after a FrameRunner made the rest of a frame.
  void note_frame(const Simulator& simulator, FrameDiagnostics frame);

  /// The next warning that was not returned yet.
  [[nodiscard]] std::optional<std::string> next();

 private:
  static constexpr std::size_t kKinds = 4;

  StepReport sums_{};  ///< of the steps of the present frame
  FrameMemory memory_{};
  std::vector<std::string> waiting_;
  std::shared_ptr<std::array<std::atomic<bool>, kKinds>> told_ = std::make_shared<std::array<std::atomic<bool>, kKinds>>();
};

}  // namespace sprung::python
