// Writes a recorded run as one HTML file, which plays without a server.
#pragma once

#include "viewer/replay_session.h"

#include <string>

namespace sprung {

/// The text of the file: the viewer's page with the run within it. Positions are quantised to 16 bits a coordinate within the run's
/// bounds, compressed frame by frame as differences.
struct HtmlAnimation {
  std::string text;
  double error = 0.0;  ///< largest distance of a coordinate from that of the run [m]
};

/// Requires the text of the page. Throws as Replay::state().
[[nodiscard]] HtmlAnimation html_animation(const Replay& replay, const std::string& page);

}  // namespace sprung
