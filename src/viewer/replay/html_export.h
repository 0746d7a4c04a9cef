// Writes a recorded run as one HTML file, which plays without a server.
#pragma once

#include "viewer/replay/replay_session.h"

#include <string>

namespace sprung {

/// The viewer's page with a run in its head, as JSON in an element with the id `sprung-run`. Positions and the vertices of
/// deforming obstacles are rounded to 16 bits a coordinate within the run's bounds. The key `data` is base 64 of a zlib stream: the
/// topology message (`topology_bytes` long), then for each time of `times` the differences of all levels to the frame before, u16:
/// their low bytes, then their high bytes (`level_bytes` in all), then for each time the states of the vertices, u8, as differences
/// to the frame before. `poses` are those of the rigid obstacles at each time: rotation by rows, then position. Paths of the scene
/// and of warnings are cut to their last names.
struct HtmlAnimation {
  std::string text;
  double error = 0.0;  ///< largest distance of a coordinate from that of the run [m]
};

/// Requires the text of the page. Throws what Replay::state() throws.
[[nodiscard]] HtmlAnimation html_animation(const Replay& replay, const std::string& page);

}  // namespace sprung
