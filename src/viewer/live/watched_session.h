// Shows a simulator that a program steps.
#pragma once

#include "simulation/simulator.h"
#include "viewer/protocol/session.h"

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace sprung {

/// Pages watch, and cannot change anything. Keeps no reference to the simulator.
class WatchedSession final : public ViewSession {
 public:
  explicit WatchedSession(std::string title);

  /// Shows the present of the simulator, at most 60 times a second, or always if it `must`. Any thread may call it between two
  /// steps of the simulator; always of the same one.
  void show(const Simulator& simulator, bool must = false);

  [[nodiscard]] std::string hello() const override;
  void start(Publisher& publisher) override;
  void stop() override;
  void handle(ClientId client, std::string text) override;
  void set_watchers(int /*count*/) override {}
  void leave(ClientId /*client*/) override {}

 private:
  void publish();

  const std::string title_;
  std::mutex mutex_;
  Publisher* publisher_ = nullptr;
  std::uint32_t generation_ = 0;  ///< of `scene_`; 0: none yet
  std::uint32_t published_ = 0;   ///< generation
  std::int64_t springs_ = -1;     ///< number of springs of that generation
  std::string scene_;
  SharedBytes topology_;
  SharedBytes frame_;
  std::chrono::steady_clock::time_point shown_{};
};

}  // namespace sprung
