#include "viewer/live/watched_session.h"

#include "viewer/live/live_texts.h"
#include "viewer/live/shown_simulator.h"
#include "viewer/protocol/text_messages.h"

#include <memory>
#include <utility>

namespace sprung {
namespace {

constexpr std::chrono::microseconds kLeastInterval{1'000'000 / 60};

}  // namespace

WatchedSession::WatchedSession(std::string title) : title_(std::move(title)) {}

void WatchedSession::show(const Simulator& simulator, bool must) {
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (!must && now - shown_ < kLeastInterval) return;
  shown_ = now;
  MessageHeader header{.generation = generation_,
                       .frame = 1 + static_cast<std::uint32_t>(simulator.state().frame),
                       .time = simulator.time(),
                       .playing = true};
  if (simulator.network().springs.count() != springs_) {
    springs_ = simulator.network().springs.count();
    header.generation = ++generation_;
    scene_ = watched_text(generation_, title_, simulator);
    topology_ = std::make_shared<const Bytes>(topology_message(header, topology_of(simulator)));
  }
  frame_ = std::make_shared<const Bytes>(frame_message(header, numbers_of(simulator), state_of(simulator)));
  publish();
}

/// Requires the mutex.
void WatchedSession::publish() {
  if (publisher_ == nullptr || !frame_) return;
  if (std::exchange(published_, generation_) != generation_) publisher_->show_scene(0, scene_, topology_);
  publisher_->show_frame(0, frame_);
}

std::string WatchedSession::hello() const { return hello_text("live", title_, {}); }

void WatchedSession::start(Publisher& publisher) {
  const std::lock_guard lock(mutex_);
  publisher_ = &publisher;
  publisher.show_state(state_text({}));
  publish();
}

void WatchedSession::stop() {
  const std::lock_guard lock(mutex_);
  publisher_ = nullptr;
}

void WatchedSession::handle(ClientId client, std::string /*text*/) {
  const std::lock_guard lock(mutex_);
  if (publisher_ == nullptr) return;
  publisher_->tell(client, error_text("a program steps this simulator: the page shows it, and cannot change it"));
}

}  // namespace sprung
