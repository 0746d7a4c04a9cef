// Which particles move freely: pins hold some of them, others sleep.
#pragma once

#include "base/types.h"
#include "network/model/pin.h"

#include <cstdint>
#include <vector>

namespace sprung {

struct Body;
struct SpringNetwork;

enum class PinPhase : std::uint8_t { waiting, holding, over };

/// What decides which particles forces move.
struct Activity {
  std::vector<PinPhase> phases;  ///< of each pin
  std::vector<Index> pin_of;     ///< by particle: the number of the pin that holds it; kNone: none
  std::vector<char> asleep{};    ///< by particle; empty: none sleeps

  [[nodiscard]] bool is_pinned(Index particle) const { return pin_of[particle] != kNone; }
  [[nodiscard]] bool is_asleep(Index particle) const { return !asleep.empty() && asleep[particle] != 0; }
  [[nodiscard]] bool operator==(const Activity&) const = default;
};

/// The time before which pins begin and end that do so at this step of a simulation or an earlier one: times are rounded to steps.
/// [s], as `step_length`.
[[nodiscard]] inline double due_before(std::int64_t step, double step_length) {
  return (static_cast<double>(step) + 0.5) * step_length;
}

/// Whether a pin has begun and not ended before `time` [s].
[[nodiscard]] bool holds_at(const Pin& pin, double time);

/// Whether a pin moves, now or later.
[[nodiscard]] bool has_moving_pin(const std::vector<Pin>& pins);

/// Whether both pins hold particles at some time.
[[nodiscard]] bool hold_together(const Pin& a, const Pin& b);

/// The times after 0 at which pins begin and end, ascending, each once [s].
[[nodiscard]] std::vector<double> pin_changes(const std::vector<Pin>& pins);

/// No pin has begun, and no particle sleeps.
[[nodiscard]] Activity all_free(const SpringNetwork& network);

/// Whether a pin begins or ends before `time` [s] that has not yet done so.
[[nodiscard]] bool have_pins_changed(const std::vector<Pin>& pins, const Activity& activity, double time);

/// Ends the pins that end before `time` [s], which frees their particles. Then pins begin that do so before `time`. A particle that
/// another pin holds stays with that pin.
void change_pins(const std::vector<Pin>& pins, double time, Activity& activity);

/// The activity at time 0: the pins that begin then hold their particles, and none sleeps.
[[nodiscard]] Activity first_activity(const SpringNetwork& network);

/// The particles that pin number `pin` holds, in the order of Pin::particles.
[[nodiscard]] std::vector<Index> held_particles(const SpringNetwork& network, std::size_t pin);

/// Sets the activity and the inverse masses of a network: 0 of particles that are pinned or sleep.
void set_activity(Activity activity, SpringNetwork& network);

/// Whether all particles of a body sleep. True of a body without particles.
[[nodiscard]] bool is_asleep(const SpringNetwork& network, const Body& body);

/// The network with all particles free that are free at some time. Its largest stable step is stable at all times: pinning a
/// particle restricts the motion, which does not raise the largest eigenvalue (Cauchy interlacing).
[[nodiscard]] SpringNetwork freest(SpringNetwork network);

}  // namespace sprung
