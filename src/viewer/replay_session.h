// Shows a recorded run in the viewer.
#pragma once

#include "output/recorded_run.h"
#include "scene/load_scene.h"
#include "viewer/session.h"

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace sprung {

class LiveRun;

/// The bodies' surfaces and all obstacles of a recorded run. Springs and pins come from its scene, if that still builds a network
/// of the same particles.
class Replay {
 public:
  /// `mesh_paths` are the folders where the scene's meshes are looked for. Throws as RecordedRun().
  Replay(const std::filesystem::path& folder, const std::vector<std::string>& mesh_paths);
  ~Replay();

  [[nodiscard]] const RecordedRun& run() const { return run_; }
  [[nodiscard]] std::string scene_text() const;
  [[nodiscard]] Topology topology() const;

  /// The positions of a frame, counted from 1, those of obstacles too. Obstacles with a file for each frame count as deforming.
  /// Throws as RecordedRun::positions().
  [[nodiscard]] FrameState state(int frame) const;
  [[nodiscard]] FrameNumbers numbers(int frame) const;
  [[nodiscard]] double time(int frame) const { return (frame - 1) / run_.frame_rate(); }

 private:
  void show_springs_of_vertices(Topology& topology) const;
  [[nodiscard]] std::vector<char> pinned(int frame) const;

  RecordedRun run_;
  std::unique_ptr<const LiveRun> live_;  ///< of the scene, at time 0; null if it does not build
  std::vector<Index> particle_of_;       ///< of each vertex of the bodies' frames; a weld gives several the same one
};

class ReplaySession final : public ViewSession {
 public:
  /// Throws as Replay().
  ReplaySession(const std::filesystem::path& folder, const std::vector<std::string>& mesh_paths);
  ~ReplaySession() override;

  [[nodiscard]] std::string hello() const override;
  void start(Publisher& publisher) override;
  void stop() override;
  void handle(ClientId client, std::string text) override;
  void set_watchers(int /*count*/) override {}
  void leave(ClientId /*client*/) override {}

 private:
  void answer_all();
  void answer(ClientId client, const std::string& text);
  [[nodiscard]] SharedBytes frame(int number) const;

  Replay replay_;
  Publisher* publisher_ = nullptr;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::pair<ClientId, std::string>> messages_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace sprung
