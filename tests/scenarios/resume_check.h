// Whether a run that is resumed gives the same bits as one that goes on.
#pragma once

#include "simulation/simulator.h"

#include <optional>

namespace sprung::testing {

/// Chooses a step of a run at random. There the run is resumed from the bytes of its state and its caches. The states of both in
/// the frames that follow must be the same. The run itself goes on as without this check.
class ResumeCheck {
 public:
  /// The run has so many frames.
  explicit ResumeCheck(int frames);

  /// Call it before each frame after the first. In the chosen frame it makes the steps up to the chosen one, and adds their report.
  /// In the frames that follow it compares. Throws StepError.
  void begin(int frame, Simulator& simulator, StepReport& report);

 private:
  void resume(const Simulator& simulator);
  void compare(int frame, const Simulator& simulator);

  int begin_;                           ///< frame in which the run is resumed
  double fraction_;                     ///< of the frame's steps that it makes before
  std::optional<Simulator> resumed_{};  ///< none before, and after the last comparison
};

}  // namespace sprung::testing
