// What a live run has been through: its frames, for a file, and its last states, to go on from.
#pragma once

#include "output/output_frame.h"
#include "scene/load_scene.h"

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace sprung {

/// Particles whose pins the hand changed.
struct HandPins {
  std::set<Index> pinned;
  std::set<Index> released;
};

/// Keeps at most 512 MB of frames, from the first on, and at most 128 MB of states, the last ones.
class LiveRecording {
 public:
  /// Forgets all. The present state is the first frame.
  void begin(const Simulator& simulator, const HandPins& pins);

  /// To be called after each step, with its wall time [ms]. Keeps what a step leaves that ends a frame.
  void add_step(const Simulator& simulator, const StepReport& report, double step_ms, const HandPins& pins);

  /// No step goes back behind the present: states of other steps do not fit the simulator.
  void forget_states() { states_.clear(), state_bytes_ = 0; }

  struct Past {
    SimulationState state;
    HandPins pins;
  };
  /// The kept state whose time is nearest to `time` [s]; none without states.
  [[nodiscard]] std::optional<Past> state_near(double time) const;

  /// Forgets frames and states after that of a number, counted from 0.
  void cut_after(std::int64_t frame);

  /// Writes the frames and the present state as the folder of a run, and makes the folder. Requires the scene of the frames. Throws
  /// FileError if the folder exists or cannot be written; nothing of it then remains.
  void save(const std::filesystem::path& folder, const LoadedScene& loaded, const std::optional<StepFailure>& failure) const;

  [[nodiscard]] std::size_t frames() const { return frames_.size(); }

 private:
  struct KeptState {
    std::int64_t frame = 0;  ///< counted from 0
    double time = 0.0;       ///< [s]
    std::string bytes;
    HandPins pins;
  };

  void keep(const Simulator& simulator, const FrameDiagnostics& diagnostics, const HandPins& pins);

  std::vector<OutputFrame> frames_;
  std::size_t frame_bytes_ = 0;
  std::deque<KeptState> states_;
  std::size_t state_bytes_ = 0;
  // Of the frame that is being made.
  StepSums sums_;
  double ms_ = 0.0;
};

}  // namespace sprung
