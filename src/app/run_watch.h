// What the user should be told of a run, as it happens or at its end.
#pragma once

#include "app/energy_gain.h"
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

  /// After the last frame: tells by how much the stretch limit was missed, of bodies too thin to lie on each other, and of energy
  /// from nowhere. Throws FileError.
  void tell();

 private:
  void warn(const std::string& warning);
  void see_infeasible(const FrameDiagnostics& frame);
  void see_stretch(const FrameDiagnostics& frame);
  void see_handovers();
  void see_held_back(const FrameDiagnostics& frame);
  void tell_of_thin_bodies();

  struct Missed {
    int frames = 0;
    double most = 0.0;  ///< as a part of a rest length
    int worst_frame = 0;
  };

  const Simulator& simulator_;
  RunOutput& output_;
  bool quiet_;
  bool infeasible_ = false;
  Missed missed_;
  EnergyGain gain_;
  int frames_ = 0;
  int held_back_ = 0;              ///< frames in which many particles were
  std::vector<bool> handed_over_;  ///< by body
};

}  // namespace sprung
