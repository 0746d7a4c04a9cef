// Projection-based limits on how far springs stretch or shrink (Provot 1995; Jakobsen 2001; Mueller et al. 2007).
#pragma once

#include "base/files/binary_archive.h"
#include "base/types.h"
#include "dynamics/state/simulation_state.h"
#include "dynamics/tethers/stretch_limit_settings.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sprung {

struct Body;
class LongRangeAttachments;
struct RodRow;
struct SpringBatches;
struct SpringNetwork;
class StretchNewton;

/// The relative excess over the limit that automatic steps are chosen for: half of `max_stretch` plus `tolerance`, and at least
/// 0.001.
[[nodiscard]] double wanted_excess(const StretchLimitSettings& settings);

/// The excess above which the limit counts as missed: `wanted_excess`, or three times as much if contacts are found less often
/// than passes are made. A hanging body bounces to half of that at first.
[[nodiscard]] double tolerated_excess(const StretchLimitSettings& settings, bool has_inner_substeps);

/// The largest number of passes of a step, or of an inner substep, which is short and adds little excess.
[[nodiscard]] int passes_of(const StretchLimitSettings& settings, bool has_inner_substeps);

class StretchLimit {
 public:
  /// Keeps a reference to the network. Springs of rest length 0 have no relative length and are left out.
  StretchLimit(const SpringNetwork& network, const StretchLimitSettings& settings, const LimitUse& use = {});
  ~StretchLimit();

  /// One Gauss-Seidel pass in batches without common particles. Each spring beyond its limits is projected onto them, both ends
  /// weighted by inverse mass; pinned particles do not move. Tethers come first. Gives the same bits for any number of threads.
  /// Returns the largest relative excess before the projection.
  ///
  /// A spring that is too short is pushed along its direction `before` the step (as in SHAKE: Ryckaert, Ciccotti and Berendsen
  /// 1977). A push along its present direction does work on a rotating body: it gave a cube that swung from an edge as much energy
  /// in ten seconds as its swing had. A pull along the present direction removes energy, and keeps the length of springs that
  /// rotate far in a step.
  ///
  /// `relaxation`, in (0, 2), scales the corrections. Passes still converge on lengths that are not too long, because these are a
  /// convex set (Agmon 1954; Motzkin and Schoenberg 1954). Over-relaxation spreads the excess faster where many springs share it.
  ///
  /// A recorder gets the impulses of springs and tethers, which takes a pass about twice the time.
  double project(const Points& before, Points& positions, double relaxation = 1.0, const ImpulseRecorder& recorder = {}) const;

  /// Newton's method on all springs that are too long, for the components that `solver` chooses: moves free particles to positions
  /// where springs are within max_stretch, with the least weighted displacement. Compression and contact are left to the passes.
  /// `before` are the positions at the beginning of the step. `steady_displacement` [m] is a dt^2 with the largest steady
  /// acceleration a of gravity and wind. `handovers` says for each body whether it was handed over; it may be empty. Returns the
  /// largest number of linear systems of a component; none if nothing was too long. A recorder gets the impulses of springs.
  std::optional<int> solve(const Points& before, Points& positions, double steady_displacement,
                           const std::vector<StretchHandover>& handovers = {}, const ImpulseRecorder& recorder = {}) const;

  /// The same with rods that join bodies; see StretchNewton. Adds what it pushed on the first ends of rods to `pushes` [kg m].
  std::optional<int> solve(const Points& before, Points& positions, double steady_displacement,
                           const std::vector<StretchHandover>& handovers, std::span<const RodRow> rods,
                           std::vector<Vector3>& pushes, const ImpulseRecorder& recorder) const;

  /// See StretchNewton::forget().
  void forget_solves() const;
  void save_solves(ByteWriter& to) const;
  void load_solves(BinaryReader& from) const;

  /// The largest relative excess over the limits.
  [[nodiscard]] double excess(const Points& positions) const;

  /// The largest relative excess of one body's springs.
  [[nodiscard]] double excess(const Points& positions, const Body& body) const;

  [[nodiscard]] const StretchLimitSettings& settings() const;

  /// The solver that `solver` stands for in this network: `newton`, `gauss_seidel`, or both with the bodies and the step of a
  /// handover.
  [[nodiscard]] std::string chosen_solver() const;

  /// Whether a body, by its number, may be handed over to Newton's method if passes miss its limit.
  [[nodiscard]] bool may_be_handed_over(std::size_t body) const;

  /// The step [s] at which `iterations` passes a step keep the excess at about `wanted_excess` while each body hangs at rest under
  /// `acceleration` [m/s^2] by its pins or over an obstacle: in each step gravity adds g dt^2 per supported particle, which the
  /// passes must distribute. It is larger with tethers to taut pins (see are_pins_taut). Infinity if nothing is limited, and for
  /// bodies that Newton's method solves, which need no small steps.
  [[nodiscard]] double suggested_step(double acceleration) const;

  /// The step [s] in which layers of falling bodies with self-contact and without stiffness move by half their thickness. Infinity
  /// without such bodies.
  [[nodiscard]] double step_for_layers(double acceleration) const;

  /// Whether steps may be refined where the limit is missed. The correction of an excess in a smaller step gives springs more
  /// speed. Surfaces whose springs neither stretch nor shrink, that are rigid within themselves and have tethers dissipate it;
  /// others become slack and are thrown.
  [[nodiscard]] bool bears_smaller_steps() const;

  /// Whether Newton's method solves for any springs from the start.
  [[nodiscard]] bool uses_newton() const;

  /// Whether Newton's method solves for all springs, counting the bodies that were handed over. It keeps the limit at any step,
  /// but removes more motion the larger the relative deformation in a step, so that steps are chosen by `deformation`.
  [[nodiscard]] bool follows_deformation(const std::vector<StretchHandover>& handovers = {}) const;

  /// Whether follows_deformation() will be true once all bodies that may be handed over are; the small steps of passes are then no
  /// longer needed.
  [[nodiscard]] bool may_follow_deformation() const;

  /// Largest relative deformation in the last solve() [1]: per component, the largest displacement minus the common displacement,
  /// divided by the component's extent.
  [[nodiscard]] double deformation() const;

 private:
  const SpringNetwork& network_;
  StretchLimitSettings settings_;
  std::unique_ptr<const SpringBatches> batches_;
  std::unique_ptr<const LongRangeAttachments> tethers_;  ///< none unless the settings say so
  std::unique_ptr<StretchNewton> newton_;
};

}  // namespace sprung
