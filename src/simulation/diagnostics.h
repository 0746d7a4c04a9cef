// Diagnostics of a frame, and the loop that computes frames.
#pragma once

#include "base/types.h"
#include "dynamics/state/simulation_state.h"
#include "simulation/step/step_report.h"

#include <cstdint>
#include <optional>

namespace sprung {

class Simulator;

/// Sums are over the steps of the frame.
struct FrameDiagnostics {
  int frame = 1;                       ///< frame 1 is the state at time 0
  double time = 0.0;                   ///< [s]
  double kinetic_energy = 0.0;         ///< [J]
  double elastic_energy = 0.0;         ///< [J]
  double gravity_energy = 0.0;         ///< [J]
  double contact_energy = 0.0;         ///< of penalty springs [J]
  double max_stretch = 0.0;            ///< largest (|s| - d) / d of structural springs
  double stretch_excess = 0.0;         ///< largest excess over the stretch limit [fraction of the rest length]
  Index contacts = 0;                  ///< particles that contact pushed in the last step
  std::optional<double> min_distance;  ///< smallest distance of a particle from an obstacle [m]; none without obstacles, or if all
                                       ///< are farther than the size of the network
  Index truncated = 0;                 ///< particles that truncation stopped, summed
  Index infeasible = 0;                ///< particles without an admissible position, summed
  Index max_infeasible = 0;            ///< the most of them in one substep
  Index inverted_cells = 0;            ///< cells of solids that are inside out
  std::int64_t substeps = 0;           ///< number of substeps
  PlanReason reason = PlanReason::first;  ///< why the step with the most substeps has so many
  double smallest_step = 0.0;             ///< length of the shortest substep [s]; 0 without steps
  std::int64_t limit_solves = 0;          ///< linear systems solved for the stretch limit, summed
  double frame_ms = 0.0;                  ///< wall time of computing the frame
};

// These read the simulator, over all particles or springs, and may run in several threads at the same time, but not during a step.

/// [J]
[[nodiscard]] double kinetic_energy(const Simulator& simulator);

/// Largest (|s| - d) / d of structural springs; 0 if none is longer than at rest.
[[nodiscard]] double max_stretch(const Simulator& simulator);

/// Number of cells of solids that are inside out.
[[nodiscard]] Index inverted_cells(const Simulator& simulator);

/// Of the present state; what is summed over steps is 0. Costs a search for the obstacle that is nearest to each particle.
[[nodiscard]] FrameDiagnostics present_diagnostics(const Simulator& simulator);

/// The same without min_distance, and so without that search.
[[nodiscard]] FrameDiagnostics diagnostics_without_distance(const Simulator& simulator);

/// What the diagnostics of a frame sum over its steps.
class StepSums {
 public:
  void add(const StepReport& step);
  /// `step`: length of the steps [s].
  void write(double step, FrameDiagnostics& diagnostics) const;

 private:
  StepReport sum_;
  int max_substeps_ = 1;
  PlanReason reason_ = PlanReason::first;
};

/// Runs a simulator frame by frame. Keeps a reference to it. Not for several threads at the same time. Beside the steps, a frame
/// costs a search for the obstacle that is nearest to each particle, and one pass over springs and cells.
class FrameRunner {
 public:
  explicit FrameRunner(Simulator& simulator);

  /// Diagnostics of the state at time 0.
  [[nodiscard]] FrameDiagnostics first_frame() const;

  /// Runs the steps to the end of the present frame (see SimulatorSettings::steps_per_frame). Forces of pins and springs are then
  /// means over the frame. Throws StepError.
  FrameDiagnostics next_frame();

 private:
  Simulator& simulator_;
};

}  // namespace sprung
