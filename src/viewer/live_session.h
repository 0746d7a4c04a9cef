// Simulates a scene for the viewer, in a thread of its own.
#pragma once

#include "viewer/live_run.h"
#include "viewer/session.h"
#include "viewer/text_messages.h"

#include <chrono>
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

/// A scene of the menu.
struct ExampleScene {
  std::string name;
  std::string file;
};

class LiveSession final : public ViewSession {
 public:
  /// Throws FileError if the scene cannot be read. Problems of the scene are shown on the page.
  LiveSession(SceneSource source, std::vector<ExampleScene> examples);
  ~LiveSession() override;

  [[nodiscard]] std::string hello() const override;
  void start(Publisher& publisher) override;
  void handle(ClientId client, std::string text) override;
  void set_watchers(int count) override;

 private:
  struct Shown;

  void simulate();
  void take_commands(std::vector<std::pair<ClientId, std::string>>& commands);
  void obey(ClientId client, const std::string& text);
  void open(const SceneSource& source, const std::string& key);
  void compare(const std::string& integrator);
  void change(std::optional<std::uint32_t> run, const std::string& key, const std::string& value);
  void begin_run(std::uint32_t number, bool live);
  void advance(int steps);
  void publish_frame(Shown& shown);
  void publish_state();
  [[nodiscard]] int steps_of_frame() const;
  [[nodiscard]] bool all_diverged() const;

  const SceneSource first_source_;
  const std::vector<ExampleScene> examples_;
  Publisher* publisher_ = nullptr;

  // Shared with the server's thread.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::pair<ClientId, std::string>> commands_;
  int watchers_ = 0;
  bool ending_ = false;

  // Of the simulation's thread.
  std::vector<std::unique_ptr<Shown>> runs_;
  PlayState play_;
  std::uint32_t next_generation_ = 1;
  std::chrono::steady_clock::time_point due_;  ///< of the next frame

  std::thread thread_;
};

}  // namespace sprung
