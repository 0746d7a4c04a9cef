// Which springs break, and which of them wait because an earlier break unloads them.
//
// A break unloads its surroundings by a wave that runs from spring to spring with the speed of sound. A spring that is too long and
// has not been reached yet would break too, everywhere in a body that is loaded evenly, although the first break relieves it.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// The springs that are longer than their break length at these positions [m], and need not wait at this time [s] for the waves of
/// earlier breaks: the one with the largest ratio of both lengths first. Until a body has lost a spring, none of it waits. Then a
/// spring waits
/// - until twice the time in which the wave of each break of the body reaches it, as fronts widen on their way. A spring at a tear
///   waits for the breaks beside it alone, so that two tears run at the same time;
/// - while it becomes shorter at these velocities [m/s];
/// - away from tears, until the body's recoil has gone to and fro: 16 times that time, unless its strain is 1.5 times the one at
///   which it breaks. Another load breaks it before that, but not the recoil of an elastic body.
/// Costs a pass over all springs that may break.
[[nodiscard]] std::vector<Index> springs_due(const SpringNetwork& network, const Points& positions, const Points& velocities,
                                             double time, const std::vector<Unloading>& unloading);

/// Of springs that are due, in their order, those that break at this time [s], ascending: each lets others wait for its wave, which
/// is noted in `unloading`. None if none is due. Costs a search over the body for each break.
[[nodiscard]] std::vector<Index> breaking_springs(const SpringNetwork& network, const std::vector<Index>& due, double time,
                                                  std::vector<Unloading>& unloading);

/// The times [s] in which a wave from a spring reaches each particle along the springs; infinity where none leads. It crosses a
/// spring in sqrt(m / k), m the harmonic mean of the masses at its ends: the time of a long wave in a row of such springs.
[[nodiscard]] std::vector<double> wave_times(const SpringNetwork& network, Index spring);

}  // namespace sprung
