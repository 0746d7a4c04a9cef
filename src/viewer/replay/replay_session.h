// Shows a recorded run in the viewer.
#pragma once

#include "output/recorded_run.h"
#include "viewer/protocol/session.h"

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

/// A recorded run as the page shows it: the vertices of its frames, the springs and pins between them, and its obstacles.
class Replay {
 public:
  /// Throws as RecordedRun().
  explicit Replay(const std::filesystem::path& folder);

  [[nodiscard]] const RecordedRun& run() const { return run_; }
  [[nodiscard]] std::string scene_text() const;
  [[nodiscard]] Topology topology() const;

  /// A frame, counted from 1. Throws as RecordedRun::frame().
  [[nodiscard]] FrameState state(int frame) const;
  [[nodiscard]] FrameNumbers numbers(int frame) const;
  [[nodiscard]] double time(int frame) const { return (frame - 1) / run_.frame_rate(); }

 private:
  RecordedRun run_;
  std::vector<Index> particle_of_;  ///< of each vertex of the bodies' frames; a weld gives several the same one
  Edges springs_;                   ///< those between vertices
  std::vector<Index> spring_of_;    ///< the number of each of these in the model, ascending
};

class ReplaySession final : public ViewSession {
 public:
  /// Throws as Replay().
  explicit ReplaySession(const std::filesystem::path& folder);
  ~ReplaySession() override;

  [[nodiscard]] const RecordedRun& run() const { return replay_.run(); }

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
