// What a run leaves behind: OBJ sequences of bodies, obstacles as placed, diagnostics.csv, run.json.
#pragma once

#include "output/output_folder.h"
#include "simulation/diagnostics.h"
#include "simulation/simulator.h"

#include <string>
#include <vector>

namespace sprung {

/// What run.json tells of a run.
struct RunFacts {
  std::string scene;         ///< as resolved, JSON text
  double frame_rate = 30.0;  ///< [1/s]
  int frames = 1;
  int steps_per_frame = 1;
  int threads = 1;
  std::vector<std::string> warnings;
};

/// Writes frames as they come. diagnostics.csv and run.json are up to date after each frame.
class RunOutput {
 public:
  RunOutput(OutputFolder folder, RunFacts facts);

  /// Writes the OBJ files of all bodies (and of moving obstacles) for the simulator's present state, and the frame's row. The first
  /// call also writes the obstacles that stand still. Throws FileError.
  void write_frame(const Simulator& simulator, const FrameDiagnostics& diagnostics);

  /// Writes how the run ended into run.json: `done`, `interrupted`, `diverged: ...`. Throws FileError.
  void finish(const std::string& outcome);

 private:
  OutputFolder folder_;
  RunFacts facts_;
  std::string diagnostics_;
  int frames_written_ = 0;
  double wall_seconds_ = 0.0;
};

}  // namespace sprung
