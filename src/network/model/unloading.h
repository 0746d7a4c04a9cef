// Which springs break, and which of them wait because an earlier break unloads them.
//
// A break unloads its surroundings by a wave that runs from spring to spring with the speed of sound. In a body that is loaded
// evenly, the springs that the wave has not reached yet are too long as well. They would all break, although the first break
// relieves them.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// The springs that are longer than their break length at these positions [m], 3 x n, and do not wait at this time [s] for the
/// waves of earlier breaks. The largest ratio of length to break length comes first. `unloading` is that of SpringState. No spring
/// of a body waits before the first break of the body. After it, a spring waits
/// - for the front of each break: until twice the time that its wave takes to the spring. A spring at a tear waits for the breaks
///   beside it alone, so that two tears run at the same time;
/// - while its length decreases at these velocities [m/s], 3 x n;
/// - away from tears, for the recoil of each break: until 16 times that time, unless its strain exceeds the break strain by half.
///   Such a strain has another cause: in a row of springs with a loss factor of 0.1, the recoil reaches 0.92 times the strain at
///   the break. Without damping it reaches up to 1.8 times that strain, and may break the body again.
/// Costs a pass over all springs that may break.
[[nodiscard]] std::vector<Index> springs_due(const SpringNetwork& network, const Points& positions, const Points& velocities,
                                             double time, const std::vector<Unloading>& unloading);

/// The springs that break at this time [s], ascending: each of `due`, in its order, that need not wait for the front of one before
/// it. Adds the waves of these breaks to `unloading`. Costs a search over the body for each break.
[[nodiscard]] std::vector<Index> breaking_springs(const SpringNetwork& network, const std::vector<Index>& due, double time,
                                                  std::vector<Unloading>& unloading);

/// The time [s] at which a wave from both ends of a spring reaches each particle along the springs; infinity for particles that
/// springs do not join to it. The wave crosses a spring in sqrt(m / k), the time of a long wave in a row of equal springs. m is the
/// harmonic mean of the masses at its ends.
[[nodiscard]] std::vector<double> wave_times(const SpringNetwork& network, Index spring);

}  // namespace sprung
