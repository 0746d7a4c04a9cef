// The JSON texts to the page about a simulator that runs; see PROTOCOL.md.
#pragma once

#include "viewer/live/live_run.h"

#include <cstdint>
#include <string>

namespace sprung {

[[nodiscard]] std::string scene_text(std::uint32_t number, std::uint32_t generation, bool live, const LiveRun& run);
/// The scene of a simulator that a program steps. Its JSON text is not known.
[[nodiscard]] std::string watched_text(std::uint32_t generation, const std::string& title, const Simulator& simulator);
[[nodiscard]] std::string diverged_text(std::uint32_t number, std::uint32_t generation, const LiveRun& run);
/// See LiveRun::changed_scene().
[[nodiscard]] std::string changed_text(std::uint32_t number, const LiveRun& run, const std::string& initial_state = "");

}  // namespace sprung
