// Particles that go their way in parts of the obstacles' interval.
#pragma once

#include "collision/obstacles/environment.h"
#include "collision/truncation/vertex_truncation.h"

#include <functional>

namespace sprung {

/// What became of particles on a part of their way.
struct ClippedSubstep {
  Outcomes outcomes;
  bool sure = true;  ///< nothing has passed through anything on the way; else it is known for the part's end alone
};

/// Moves particles a part of their way, to places in `after` [m], 3 x n, while the environment's interval is that part; tells what
/// became of them, of the same ones each time.
using ClipSubstep = std::function<ClippedSubstep(const Way& part, Points& after)>;

/// Obstacles and elements that close in on each other may be led where there is no place, though there is one beside: in smaller
/// parts, planes are made again before they meet. Parts are halved while `place` finds no place for all in one, or is not sure of
/// it, down to a 64th. Returns the outcomes of the last part, but infeasible for what was so in any.
Outcomes place_in_parts(Environment& environment, const Way& way, Points& after, const ClipSubstep& place);

}  // namespace sprung
