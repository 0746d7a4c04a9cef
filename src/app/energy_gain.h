// Energy that a run gets though nothing drives it.
#pragma once

#include "simulation/diagnostics.h"

#include <optional>
#include <string>

namespace sprung {

class EnergyGain {
 public:
  /// Sees nothing where pins or obstacles move, wind blows, contact holds energy of its own (penalty), or a scheme gains by itself,
  /// which is told of elsewhere (explicit Euler).
  explicit EnergyGain(const Simulator& simulator);

  /// After each frame, from the first. That is left out: limits and contact may give a start of their own.
  void see(const FrameDiagnostics& frame);

  /// What to tell at the end: when motion, springs and height have risen together by more than half of the most that motion
  /// ever held, and by more than steps and a stretch limit let them seem to.
  [[nodiscard]] std::optional<std::string> warning() const;

 private:
  struct At {
    int frame = 0;
    double energy = 0.0;  ///< [J]
  };

  [[nodiscard]] double seeming() const;

  const Simulator& simulator_;
  bool sees_;
  std::optional<At> least_;  ///< so far
  At from_;                  ///< of the largest rise
  At to_;
  double most_kinetic_ = 0.0;  ///< [J]
};

}  // namespace sprung
