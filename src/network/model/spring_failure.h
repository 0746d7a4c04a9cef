// Springs that yield and springs that break.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Lets springs yield: those that are strained beyond their yield strain at these positions [m] get the rest length at which the
/// strain is the yield strain (perfect plasticity). Their elastic energy falls. A second call changes nothing. A spring without a
/// length, now or at rest, has no strain. Returns the springs that yielded, ascending.
std::vector<Index> let_yield(Springs& springs, const Points& positions);

/// Marks the springs that break, and the shear and bend springs that break with them: those that span a broken structural spring
/// and one next to it, and those that cross it between the third corners of two triangles. An entry per spring.
[[nodiscard]] std::vector<char> with_dependents(const Springs& springs, const std::vector<Index>& broken);

/// Removes the springs that `gone` marks, and the elements that would bridge the gap: the angle bends over them, the segments along
/// them, and the faces of which a marked structural or shear spring is a side or diagonal. `Surface::torn` lists these faces.
/// Structural springs that keep no face become segments. Requires that the triangles of surfaces are those of `triangulate`.
void tear(SpringNetwork& network, const std::vector<char>& gone);

/// The state of the springs of another network of the same particles. A spring is broken in it if one of its kind between the same
/// particles is broken. Springs that only `to` has break if they span a broken one, as in with_dependents(). A spring that yields
/// in both, and has the same number and particles, keeps its rest length.
[[nodiscard]] SpringState carried_over(const SpringNetwork& from, const SpringState& state, const SpringNetwork& to);

}  // namespace sprung
