// The stretch limit by global solves.
#pragma once

#include "base/files/binary_archive.h"
#include "dynamics/constraints/rod_row.h"
#include "dynamics/state/simulation_state.h"
#include "dynamics/tethers/stretch_limit_settings.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace sprung {

struct Body;
class ComponentImpulses;
class ComponentNewton;
class ComponentSolver;
struct SpringNetwork;
struct StretchComponent;

/// Newton's method on each component of limited springs: chains and trees by elimination, others by a sparse factor, large cloths
/// on two levels. Enforces max_stretch only, not max_compression. Gives the same bits for any number of threads. Except for chains
/// and trees, the last digits depend on earlier steps, whose factors may be reused; the same sequence of steps gives the same
/// bits.
class StretchNewton {
 public:
  /// Solves for all components from the start if `settings.solver` is newton. If it is automatic: from the start for chains,
  /// trees, ropes, and surfaces that may shrink freely and that `use` does not reserve for passes; for other ropes and surfaces
  /// after their body was handed over; never for the rest. Keeps a reference to the network.
  StretchNewton(const SpringNetwork& network, const StretchLimitSettings& settings, const LimitUse& use = {});
  ~StretchNewton();

  /// Moves free particles from the target of the forces, `positions`, to positions where no limited spring is much too long, with
  /// the least weighted displacement. `before` are the positions at the beginning of the step; `positions` holds the final
  /// positions of pins. `steady_displacement` is that of ComponentSolver. `handovers` has an entry per body or is empty. Returns
  /// the largest number of linear systems of a component; none if nothing was too long. A recorder costs about a linear system per
  /// component with several links to pins.
  std::optional<int> solve(const Points& before, Points& positions, double steady_displacement,
                           const std::vector<StretchHandover>& handovers = {}, const ImpulseRecorder& recorder = {});

  /// The same with rods, which join components: a body that hangs on a rope is part of its load. Such components are solved for
  /// from the start, unless springs may not shrink freely. Bodies that are left to passes take part with the particles of rods
  /// alone. Adds what the solve pushed on the first ends of rods to `pushes`, one per rod [kg m].
  std::optional<int> solve(const Points& before, Points& positions, double steady_displacement,
                           const std::vector<StretchHandover>& handovers, std::span<const RodRow> rods,
                           std::vector<Vector3>& pushes, const ImpulseRecorder& recorder);

  /// Discards what former solves left behind: the next solve depends on its arguments alone. Call it after the state was rolled
  /// back.
  void forget();

  /// Writes what forget() discards, and reads it back. load() throws BytesError if it is of other components; call forget() then.
  void save(ByteWriter& to) const;
  void load(BinaryReader& from);

  /// Whether all limited springs of a body are solved for from the start.
  [[nodiscard]] bool solves(const Body& body) const;
  /// Whether any component is or may be solved for.
  [[nodiscard]] bool solves_any() const { return !components_.empty(); }
  [[nodiscard]] bool solves_all() const { return left_.empty(); }

  /// Whether any component of a body, by its number, is solved for from the start, and whether more can be after a handover.
  [[nodiscard]] bool solves_any_of(std::size_t body) const;
  [[nodiscard]] bool may_take_over(std::size_t body) const;
  [[nodiscard]] bool may_take_over_any() const;

  /// The largest relative deformation of a component in the last solve, see ComponentSolver; 0 without components.
  [[nodiscard]] double deformation() const;

 private:
  /// A component that is or may be solved for.
  struct SolvedComponent {
    std::unique_ptr<ComponentSolver> solver;
    ComponentNewton* with_rods;  ///< the same, if the component has rods
    std::size_t body;
    bool from_start;
    std::size_t number;  ///< of the component among all of the network

    [[nodiscard]] bool is_solved(const std::vector<StretchHandover>& handovers) const {
      return from_start || (!handovers.empty() && handovers[body].solved_since);
    }
  };

  void make_components(std::span<const RodRow> rods);
  [[nodiscard]] std::vector<StretchComponent> all_components(std::span<const RodRow> rods) const;
  void join(std::span<const RodRow> rods);
  void record(const Points& target, const Points& positions, const std::vector<StretchHandover>& handovers,
              const ImpulseRecorder& recorder);

  const SpringNetwork& network_;
  StretchLimitSettings settings_;
  LimitUse use_;

  std::vector<SolvedComponent> components_;
  std::vector<std::unique_ptr<ComponentImpulses>> impulses_;  ///< of the components; empty until something is recorded
  std::vector<RodRow> joined_;                                ///< the rods that join the present components
  std::vector<Index> left_;                                   ///< particles that are not solved for from the start, ascending
};

}  // namespace sprung
