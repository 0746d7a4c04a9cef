// Springs that yield and springs that break.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Lets springs yield: those that are strained beyond their yield strain at these positions [m] get the rest length at which the
/// strain is the yield strain (perfect plasticity). Their elastic energy falls. A second call changes nothing. A spring without a
/// length, now or at rest, has no strain.
void let_yield(Springs& springs, const Points& positions);

/// The springs that break next at these positions [m], ascending: of each connected group of springs that are longer than their
/// break length, the one with the largest ratio of both, as it may relieve the others. In a stable step a wave does not travel
/// farther than a spring, so one break per step does not slow a crack down.
[[nodiscard]] std::vector<Index> breaking_springs(const SpringNetwork& network, const Points& positions);

/// Removes springs that broke, and what would bridge or cover the gap:
/// - the shear and bend springs that a broken structural spring spans with another one, or that cross it between the third corners
///   of two triangles;
/// - the angle bends over these springs, and the segments along them;
/// - the faces with a structural or shear spring that is gone as a side or diagonal: `Surface::torn` names them.
/// Structural springs that keep no face become segments. Requires that the triangles of surfaces are those of `triangulate`.
/// Returns the former numbers of the springs that are left, ascending.
std::vector<Index> tear(SpringNetwork& network, const std::vector<Index>& broken);

/// Removes from a network of the same bodies the springs that broke in another one, with all that went with them. Surfaces become
/// those of `torn`, where threads have the order in which faces tore. Springs that only `network` has go if they span a gap.
/// Requires that no spring of `network` broke that is whole in `torn`.
void tear_as(const SpringNetwork& torn, SpringNetwork& network);

/// Takes the rest lengths of springs that yield from another network, where both have a spring of this number between the same
/// particles.
void copy_rest_lengths(const SpringNetwork& from, SpringNetwork& network);

}  // namespace sprung
