// What the user should be told of a run, as it happens or at its end.
#pragma once

#include "output/run_output.h"
#include "simulation/diagnostics.h"

#include <vector>

namespace sprung {

/// Prints warnings, and puts them into run.json too.
class RunWatch {
 public:
  /// Of a quiet run there are warnings alone. Keeps references to both.
  RunWatch(const Simulator& simulator, RunOutput& output, bool quiet);

  /// After each frame: tells once that particles had to yield, and of each body that was handed over to another solver of the
  /// stretch limit. Throws FileError.
  void see(const FrameDiagnostics& frame);

  /// After the last frame: tells by how much the stretch limit was missed. Throws FileError.
  void tell();

 private:
  void warn(const std::string& warning);
  void see_squeezing(const FrameDiagnostics& frame);
  void see_stretch(const FrameDiagnostics& frame);
  void see_handovers();

  struct Missed {
    int frames = 0;
    double most = 0.0;  ///< as a part of a rest length
    int worst_frame = 0;
  };

  const Simulator& simulator_;
  RunOutput& output_;
  bool quiet_;
  bool squeezed_ = false;
  Missed missed_;
  std::vector<bool> handed_over_;  ///< by body
};

}  // namespace sprung
