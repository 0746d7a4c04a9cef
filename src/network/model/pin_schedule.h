// Which pins hold their particles at which time.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// The time before which pins begin and end that do so at this step of a simulation or an earlier one: times are rounded to steps.
/// [s], as `step_length`.
[[nodiscard]] inline double due_before(std::int64_t step, double step_length) {
  return (static_cast<double>(step) + 0.5) * step_length;
}

/// Whether a pin has begun and not ended before `time` [s].
[[nodiscard]] bool holds_at(const Pin& pin, double time);

/// Whether a pin moves, now or later.
[[nodiscard]] bool has_moving_pin(const SpringNetwork& network);

/// Whether both pins hold particles at some time.
[[nodiscard]] bool hold_together(const Pin& a, const Pin& b);

/// Whether a pin begins or ends before `time` [s] that `change_pins` has not yet changed.
[[nodiscard]] bool have_pins_changed(const SpringNetwork& network, double time);

/// Ends the pins that end before `time` [s], which makes their particles free. Then moves the pins of `later_pins` that begin
/// before `time` to `pins`. A particle that another pin holds stays with that pin. Sets the inverse masses.
void change_pins(SpringNetwork& network, double time);

/// The times after 0 at which pins begin and end, ascending, each once [s].
[[nodiscard]] std::vector<double> pin_changes(const SpringNetwork& network);

/// The network with all particles free that are free at some time. Its largest stable step is stable at all times: pinning a
/// particle restricts the motion, which does not raise the largest eigenvalue (Cauchy interlacing).
[[nodiscard]] SpringNetwork freest(SpringNetwork network);

}  // namespace sprung
