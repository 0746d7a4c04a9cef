// Lets particles of a network sleep.
#pragma once

#include "network/model/spring_network.h"

#include <utility>
#include <vector>

namespace sprung {

/// Lets particle i sleep if asleep[i] is not 0. An empty vector wakes all.
inline void set_asleep(std::vector<char> asleep, SpringNetwork& network) {
  Activity activity = network.activity;
  activity.asleep = std::move(asleep);
  set_activity(std::move(activity), network);
}

}  // namespace sprung
