#include "viewer/server/board.h"

#include <utility>

namespace sprung {
namespace {

template <class Item>
std::optional<Outgoing> if_new(const Item& item, std::uint64_t& seen, bool binary) {
  if (item.number <= seen) return std::nullopt;
  seen = item.number;
  if (!item.bytes) return std::nullopt;
  return Outgoing{item.bytes, binary};
}

}  // namespace

void Board::show_scene(std::uint32_t run, const std::string& scene, SharedBytes topology) {
  runs_[run] = {.scene = {text(scene), ++last_}, .topology = {std::move(topology), ++last_}};
}

void Board::show_frame(std::uint32_t run, SharedBytes frame) { runs_[run].frame = {std::move(frame), ++last_}; }

std::optional<Outgoing> Board::next(Reader& reader) const {
  if (!reader.greeted) {
    reader.greeted = true;
    return Outgoing{hello_, false};
  }
  if (auto found = if_new(state_, reader.state, false)) return found;
  if (auto found = if_new(failure_, reader.failure, false)) return found;
  if (!reader.waiting.empty()) {
    Outgoing first = std::move(reader.waiting.front());
    reader.waiting.pop_front();
    return first;
  }
  for (const auto& [number, run] : runs_) {
    Reader::Seen& seen = reader.seen[number];
    if (seen.scene > 0) {
      if (auto found = if_new(run.removal, seen.removal, false)) return found;
    }
    if (auto found = if_new(run.scene, seen.scene, false)) return found;
    if (auto found = if_new(run.topology, seen.topology, true)) return found;
    if (auto found = if_new(run.frame, seen.frame, true)) return found;
    if (auto found = if_new(run.divergence, seen.divergence, false)) return found;
  }
  return std::nullopt;
}

}  // namespace sprung
