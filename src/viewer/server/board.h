// What the pages see: the newest scene and frame of each run, and where each page is in it.
#pragma once

#include "viewer/protocol/session.h"

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace sprung {

/// A message to a page.
struct Outgoing {
  SharedBytes bytes;
  bool binary = false;
};

/// Of one page: what it was given already, and what waits for it alone.
struct Reader {
  struct Seen {
    std::uint64_t scene = 0;
    std::uint64_t topology = 0;
    std::uint64_t frame = 0;
    std::uint64_t divergence = 0;
    std::uint64_t removal = 0;
  };
  bool greeted = false;
  std::uint64_t state = 0;
  std::uint64_t failure = 0;
  std::map<std::uint32_t, Seen> seen;
  std::deque<Outgoing> waiting;
};

/// Not thread-safe. Keeps what is newest, however many scenes and frames are shown before a reader asks. Each thing that is shown
/// has a number that grows, so that a reader knows what is new to it.
class Board {
 public:
  explicit Board(const std::string& hello) : hello_(text(hello)) {}

  void show_scene(std::uint32_t run, const std::string& scene, SharedBytes topology);
  void show_frame(std::uint32_t run, SharedBytes frame);
  void show_divergence(std::uint32_t run, const std::string& divergence) { runs_[run].divergence = {text(divergence), ++last_}; }
  void remove_run(std::uint32_t run, const std::string& removal) { runs_[run] = {.removal = {text(removal), ++last_}}; }
  void show_state(const std::string& state) { state_ = {text(state), ++last_}; }
  void show_failure(const std::string& failure) { failure_ = {failure.empty() ? nullptr : text(failure), ++last_}; }

  /// The next message for a reader; none if it has everything.
  [[nodiscard]] std::optional<Outgoing> next(Reader& reader) const;

  [[nodiscard]] static SharedBytes text(const std::string& text) { return std::make_shared<const Bytes>(text.begin(), text.end()); }

 private:
  struct Item {
    SharedBytes bytes;
    std::uint64_t number = 0;
  };
  struct Run {
    Item scene{};
    Item topology{};
    Item frame{};
    Item divergence{};
    Item removal{};  ///< for readers that know the run
  };

  SharedBytes hello_;
  Item state_;
  Item failure_;
  std::map<std::uint32_t, Run> runs_;
  std::uint64_t last_ = 0;
};

}  // namespace sprung
