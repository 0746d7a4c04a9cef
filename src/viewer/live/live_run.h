// A simulation that the viewer shows and changes.
#pragma once

#include "dynamics/forces/pull_force.h"
#include "scene/load_scene.h"
#include "viewer/live/live_recording.h"
#include "viewer/protocol/message.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

class LiveRun {
 public:
  /// Reads the scene's file, once. Throws as load_scene().
  explicit LiveRun(SceneSource source);

  [[nodiscard]] const SceneSource& source() const { return source_; }
  [[nodiscard]] const LoadedScene& loaded() const { return loaded_; }
  [[nodiscard]] const Simulator& simulator() const { return loaded_.simulator; }
  [[nodiscard]] const std::optional<StepFailure>& failure() const { return failure_; }

  /// The scene as its author wrote it, with the changes, as JSON text. With an `initial_state`, it begins from the run in that
  /// folder, whose path counts from the scene's folder.
  [[nodiscard]] std::string changed_scene(const std::string& initial_state = "") const;

  /// See LiveRecording::save().
  void save(const std::filesystem::path& folder) const { recording_.save(folder, loaded_, failure_); }
  /// The number of frames that save() writes.
  [[nodiscard]] std::size_t saved_frames() const { return recording_.frames(); }

  /// Takes the pins that the hand set and freed in another run of the same bodies, at the start of this one.
  void keep_pins(const LiveRun& other);

  /// Changes keys of the scene (`key.path=json`). Returns whether the run continues with them; else it begins anew. It continues if
  /// only quantities change that a simulator can take over: gravity, air, springs, friction and the like, the stretch limit, the
  /// step (after the steps that are left of the frame). Pins of the hand stay in both cases, where the particles begin. Throws as
  /// load_scene(), and is unchanged then.
  bool change(const std::vector<std::string>& overrides);

  /// Begins anew, with the pins of the hand. Throws as load_scene(), if a mesh of the scene is gone, and is unchanged then.
  void reset();

  /// One step. Does nothing after a divergence, which failure() then describes. Throws StoppedError if `stops` says so.
  void step();
  void stop_when(std::function<bool()> stops);

  /// Goes back to the frame nearest to a time [s] whose state was kept, with the pins that the hand had set by then. Returns
  /// whether there is one. Throws InputError if its state does not fit the scene as it was changed since; the run then stays where
  /// it is.
  bool go_back(double time);

  // These do nothing after a divergence, or if there is no such particle.

  /// Takes hold of a particle, unless it is pinned.
  void grab(Index particle);
  void drag(const Vector3& target);
  /// Lets go; with `pin` the particle is fixed where it is.
  void drop(bool pin);
  /// Frees a pinned particle. Throws InputError if the step is too large for the network without the pin, which stays then.
  void release(Index particle);

  [[nodiscard]] Topology topology() const;
  [[nodiscard]] FrameState state() const;
  /// All but the times.
  [[nodiscard]] FrameNumbers numbers() const;
  /// Counted from 1.
  [[nodiscard]] std::uint32_t frame() const;

 private:
  bool continue_with(const PreparedScene& changed, const std::vector<std::string>& overrides);
  void begin_anew(LoadedScene loaded);
  void restore_pins();
  void finish_frame();
  [[nodiscard]] bool may_change(Index particle) const;

  SceneSource source_;
  LoadedScene loaded_;
  std::function<bool()> stops_;
  std::optional<StepFailure> failure_;
  std::shared_ptr<PullForce> pull_;
  Index pulled_ = kNone;
  Index infeasible_ = 0;  ///< in the last step
  HandPins hand_;
  LiveRecording recording_;
};

}  // namespace sprung
