// Whether a run that is resumed gives the same bits as one that goes on.
#pragma once

#include "simulation/simulator.h"

#include <memory>

namespace sprung::testing {

/// Chooses a step of a run at random, clears its caches there, as each run does at some frames, resumes a copy of it from the bytes
/// of its state, and compares the positions and velocities of both in the frames that follow.
class ResumeCheck {
 public:
  /// The run has so many frames.
  explicit ResumeCheck(int frames);

  /// Call it before each frame after the first. In the chosen frame it makes the steps up to the chosen one, adds their report, and
  /// resumes the copy. Throws StepError.
  void begin(int frame, Simulator& simulator, StepReport& report);

  /// Call it after each frame, whose number counts from 1.
  void look(int frame, const Simulator& simulator);

  /// Call it at the end of a run that did not diverge.
  void judge() const;

 private:
  int begin_;        ///< frame in which the copy is made
  double fraction_;  ///< of the frame's steps that it makes before
  std::unique_ptr<Simulator> resumed_;
  int first_different_ = 0;  ///< frame; 0: none
};

}  // namespace sprung::testing
