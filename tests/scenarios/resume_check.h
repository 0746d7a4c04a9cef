// Whether a run that is resumed gives the same bits as one that goes on.
#pragma once

#include "simulation/simulator.h"

namespace sprung::testing {

/// Chooses a step of a run at random. There a copy makes a frame, clears its caches, as each run does at some frames, and is
/// resumed from the bytes of its state. The states of both in the frames that follow must be the same. The run itself goes on as
/// without this check.
class ResumeCheck {
 public:
  /// The run has so many frames.
  explicit ResumeCheck(int frames);

  /// Call it before each frame after the first. In the chosen frame it makes the steps up to the chosen one, and adds their report.
  /// Throws StepError.
  void begin(int frame, Simulator& simulator, StepReport& report);

 private:
  void compare(const Simulator& simulator);

  int begin_;        ///< frame in which the copy is made
  double fraction_;  ///< of the frame's steps that it makes before
};

}  // namespace sprung::testing
