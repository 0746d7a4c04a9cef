// Projection-based limits on how far springs stretch or shrink (Provot 1995; Jakobsen 2001; Mueller et al. 2007).
#pragma once

#include "dynamics/tethers/stretch_limit_settings.h"
#include "network/simulation_state.h"
#include "network/spring_network.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprung {

struct SpringBatches;
class StretchNewton;
class LongRangeAttachments;

/// The excess over the limit, as a part of the rest length, that automatic steps are chosen for: half of `max_stretch` plus
/// `tolerance`, and at least a thousandth.
[[nodiscard]] double wanted_excess(const StretchLimitSettings& settings);

class StretchLimit {
 public:
  /// Keeps a reference to the network. Springs of rest length 0 cannot be measured in parts of it and are left out.
  StretchLimit(const SpringNetwork& network, const StretchLimitSettings& settings, const LimitUse& use = {});
  ~StretchLimit();

  /// One Gauss-Seidel pass in batches without shared particles: each spring beyond its limits is projected onto them, both ends
  /// weighted by inverse mass; pinned particles do not move. Tethers come first. Same bits for any number of threads. Returns the
  /// largest excess it met, as a part of the rest length.
  ///
  /// What is too short is pushed along the direction it had `before`, where the step began (as SHAKE does: Ryckaert, Ciccotti and
  /// Berendsen 1977). Along the one it has now a push on what turns would do work, and gave a cube that swung from an edge as much
  /// energy in ten seconds as its swing had; a pull takes energy so, and keeps what turns far in a step at its length.
  ///
  /// With a `relaxation` other than 1, in (0, 2), corrections are so many times as large. Passes converge all the same, on lengths
  /// that are not too long because these are a convex set (Agmon 1954; Motzkin and Schoenberg 1954), and hand excess on faster
  /// where many springs share it.
  double project(const Points& before, Points& positions, double relaxation = 1.0) const;

  /// Newton's method on all that is too long at once, as `solver` chooses: leads free particles to where springs are within
  /// their limits, with as little weighted movement as that takes. What is left is for the passes: compression, and what contact
  /// does. `before` is where the step began; `fall` [m] is a dt^2 with the largest steady acceleration a, of gravity and wind;
  /// `holds` tells of each body whether it was handed over, and is empty when none was. Returns how many linear systems were
  /// solved in turn; none when no spring that is solved for was too long.
  std::optional<int> solve(const Points& before, Points& positions, double fall,
                           const std::vector<StretchHandover>& holds = {}) const;

  /// The largest excess over the limits, as a part of the rest length; changes nothing.
  [[nodiscard]] double excess(const Points& positions) const;

  /// That of the springs of one body.
  [[nodiscard]] double excess(const Points& positions, const Body& body) const;

  [[nodiscard]] const StretchLimitSettings& settings() const;

  /// What `solver` comes to for this network: `newton`, `gauss_seidel`, or both and for which bodies, or when.
  [[nodiscard]] std::string chosen_solver() const;

  /// Whether a global solve may take over from passes that miss the limit of a body, by its number.
  [[nodiscard]] bool may_be_handed_over(std::size_t body) const;

  /// The step [s] at which `iterations` passes a step keep the excess at about `wanted_excess` when each
  /// body hangs at rest under `acceleration` [m/s^2] by its pins, or over an obstacle: in each step gravity adds g dt^2 per carried
  /// particle, and the passes must hand it on. Larger with tethers to pins that are taut (see are_pins_taut). Infinity when nothing
  /// is limited, and for what a global solve holds, which needs no small steps.
  [[nodiscard]] double suggested_step(double acceleration) const;

  /// Whether steps may become smaller where the limit is missed. What a smaller step takes back of the excess gives springs speed:
  /// surfaces whose springs neither stretch nor shrink, hold the shape and have tethers lose it within themselves, others go slack
  /// and are thrown.
  [[nodiscard]] bool bears_smaller_steps() const;

  /// Whether a global solve holds all springs, with those of bodies that were handed over: it does at any step, but the larger a
  /// part of its extent a body turns by in one, the more of its motion that takes. Steps are to be chosen by `turn`.
  [[nodiscard]] bool follows_turn(const std::vector<StretchHandover>& holds = {}) const;

  /// Whether it does not at the start, but will once all bodies are handed over that may be: then it no longer needs the small
  /// steps of passes.
  [[nodiscard]] bool may_follow_turn() const;

  /// That of the last `solve`: how far a particle was led by forces as a part of the extent of what it belongs to, apart from what
  /// all of that has in common; the largest of all that is solved for.
  [[nodiscard]] double turn() const;

 private:
  const SpringNetwork& network_;
  StretchLimitSettings settings_;
  std::unique_ptr<const SpringBatches> batches_;
  std::unique_ptr<const LongRangeAttachments> tethers_;  ///< none unless the settings say so
  std::unique_ptr<StretchNewton> newton_;
};

}  // namespace sprung
