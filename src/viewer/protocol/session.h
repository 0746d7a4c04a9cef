// What the server shows: a session publishes runs and answers the pages.
#pragma once

#include "viewer/protocol/message.h"

#include <cstdint>
#include <string>

namespace sprung {

/// A page that is connected.
using ClientId = std::uint64_t;

/// A session that is busy for long drops messages beyond so many.
inline constexpr std::size_t kMaxMessages = 10000;

/// Where a session publishes. Functions are thread-safe and return at once. Texts are JSON, see PROTOCOL.md.
class Publisher {
 public:
  virtual ~Publisher() = default;

  /// Begins a run, or a new generation of it. Pages that come later get it too.
  virtual void show_scene(std::uint32_t run, std::string scene, SharedBytes topology) = 0;

  /// Replaces the frame of a run. A page that is still busy with an earlier one gets the newest only.
  virtual void show_frame(std::uint32_t run, SharedBytes frame) = 0;

  /// Ends a run with the text `diverged`, which pages get that come later too.
  virtual void show_divergence(std::uint32_t run, std::string text) = 0;

  /// Ends a run with the text `removed`.
  virtual void remove_run(std::uint32_t run, std::string text) = 0;

  /// Replaces the text `state`, which pages get that come later too.
  virtual void show_state(std::string text) = 0;

  /// Replaces the text that tells why there is nothing to show; empty once there is.
  virtual void show_failure(std::string text) = 0;

  virtual void tell_all(std::string text) = 0;
  virtual void tell(ClientId client, std::string text) = 0;

  /// Sends a frame that a page asked for.
  virtual void send(ClientId client, SharedBytes frame) = 0;
};

class ViewSession {
 public:
  virtual ~ViewSession() = default;

  /// The text `hello`.
  [[nodiscard]] virtual std::string hello() const = 0;

  /// Begins to publish. Call it once.
  virtual void start(Publisher& publisher) = 0;

  /// Ends what start() began: the publisher is not used any more when this returns.
  virtual void stop() = 0;

  /// Takes a message of a page, which may be anything. Thread-safe; returns at once.
  virtual void handle(ClientId client, std::string text) = 0;

  /// Takes the number of pages. Thread-safe; returns at once.
  virtual void set_watchers(int count) = 0;

  /// A page is gone. Thread-safe; returns at once.
  virtual void leave(ClientId client) = 0;
};

}  // namespace sprung
