// Simulates a scene for the viewer, in a thread of its own.
#pragma once

#include "viewer/live/live_run.h"
#include "viewer/live/live_texts.h"
#include "viewer/protocol/example_scenes.h"
#include "viewer/protocol/page_command.h"
#include "viewer/protocol/session.h"
#include "viewer/protocol/text_messages.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace sprung {

class LiveSession final : public ViewSession {
 public:
  using TellProblems = std::function<void(const std::vector<Problem>&)>;

  /// Throws FileError if the scene cannot be read. Problems of the scene are shown on the page; those of the first attempt to open
  /// it are also told to `tell_problems`, in the thread of the session. Pages may save into the folder `save_to`, or, if it is
  /// empty, into that of the scene.
  LiveSession(SceneSource source, std::vector<ExampleScene> examples, TellProblems tell_problems = {},
              std::filesystem::path save_to = {});
  ~LiveSession() override;

  [[nodiscard]] std::string hello() const override;
  void start(Publisher& publisher) override;
  void stop() override;
  void handle(ClientId client, std::string text) override;
  void set_watchers(int count) override;
  void leave(ClientId client) override;

 private:
  struct Shown;
  struct Message {
    ClientId client = 0;
    std::string text;
    bool is_last = false;  ///< the page is gone; there is no text
  };

  void simulate();
  [[nodiscard]] bool is_ending();
  [[nodiscard]] bool take_messages(std::vector<Message>& messages);
  void obey(const Message& message);
  void obey(ClientId client, const PageCommand& command);
  [[nodiscard]] bool control(const PageCommand& command);
  [[nodiscard]] bool interact(ClientId client, const PageCommand& command);
  [[nodiscard]] Shown& run_of(const PageCommand& command);
  void play(bool playing);
  void reset();
  [[nodiscard]] const ExampleScene& example_of(const PageCommand& command) const;
  void tell_picture(ClientId client, const ExampleScene& example);
  bool open(const SceneSource& source);
  void look_at_file();
  void compare(const std::string& integrator);
  void end_comparison();
  void change(std::optional<std::uint32_t> run, const std::string& key, const std::string& value);
  void drop(bool pin);
  void go_back(double time);
  void tell_tension(ClientId client, const PageCommand& command);
  void tell_obj(ClientId client, const Shown& shown, const std::string& body_name);
  void tell_scene(ClientId client, const PageCommand& command);
  void save(ClientId client, const PageCommand& command);
  template <class Save>
  void attempt_to_save(ClientId client, const Save& save);
  [[nodiscard]] std::filesystem::path save_folder() const;
  template <class Action>
  void attempt(std::optional<std::uint32_t> run, const std::string& key, const Action& action);
  void refuse(std::optional<std::uint32_t> run, const std::string& key, const std::vector<Problem>& problems);
  void begin_run(std::uint32_t number, bool live);
  void advance_frame();
  void advance(Shown& shown, int steps);
  void publish_frame(Shown& shown);
  void publish_state();
  [[nodiscard]] int steps_of_frame(const Shown& shown) const;
  [[nodiscard]] bool all_diverged() const;

  const SceneSource first_source_;
  const std::vector<ExampleScene> examples_;
  TellProblems tell_problems_;  ///< until the scene was opened once
  const std::filesystem::path save_to_;
  Publisher* publisher_ = nullptr;

  // Shared with the server's thread.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Message> messages_;
  int watchers_ = 0;
  bool ending_ = false;

  // Of the simulation's thread.
  std::vector<std::unique_ptr<Shown>> runs_;
  PlayState play_;
  ClientId puller_ = 0;  ///< the page that took hold of a particle last
  std::uint32_t next_generation_ = 1;
  std::chrono::steady_clock::time_point due_;  ///< of the next frame
  // The file of the scene, as it was when it was looked at last.
  std::chrono::steady_clock::time_point looked_{};
  std::string watched_;
  std::filesystem::file_time_type written_{};

  std::thread thread_;
};

}  // namespace sprung
