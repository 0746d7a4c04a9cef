// The JSON texts to the page; see PROTOCOL.md.
#pragma once

#include "base/error.h"
#include "viewer/protocol/example_scenes.h"
#include "viewer/protocol/message.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

struct PlayState {
  bool playing = true;
  int every = 0;       ///< steps between shown frames; 0: those of the scene's frame rate
  double speed = 1.0;  ///< at most this times real time; 0: no bound
};

[[nodiscard]] std::string hello_text(const std::string& mode, const std::string& title, const std::vector<ExampleScene>& examples);
[[nodiscard]] std::string picture_text(const std::string& example, const Bytes& png);
[[nodiscard]] std::string state_text(const PlayState& state);
/// Without a run there is none to show.
[[nodiscard]] std::string problems_text(std::optional<std::uint32_t> run, const std::string& key,
                                        const std::vector<Problem>& problems);
[[nodiscard]] std::string obj_message(const std::string& name, const std::string& text);
/// Of a spring [N]; `with_limit` says whether the pull of the stretch limit is in it, or there is none.
[[nodiscard]] std::string tension_text(std::uint32_t run, Index spring, double tension, bool with_limit);
/// What was saved; without a name, why nothing was.
[[nodiscard]] std::string saved_text(const std::string& name, const std::string& text);
/// Something that happened without a command.
[[nodiscard]] std::string notice_text(const std::string& text);
[[nodiscard]] std::string error_text(const std::string& text);
[[nodiscard]] std::string removed_text(std::uint32_t run);

}  // namespace sprung
