// A stretch limit by global solves: springs that hang together are brought within it all at once.
#pragma once

#include "dynamics/tethers/stretch_limit_settings.h"
#include "network/simulation_state.h"

#include <memory>
#include <optional>
#include <vector>

namespace sprung {

class ComponentSolver;
struct StretchComponent;

/// Newton's method on each component of limited springs: chains and trees by elimination, others by a sparse factor, large
/// cloths on two levels. Only max_stretch is held, not max_compression. Same bits for any number of threads. Of what is not a chain
/// or a tree a step's later digits depend on the steps before, whose factors it may use: the same steps one after the other have
/// the same bits.
class StretchNewton {
 public:
  /// Takes all components from the start, or, when `settings.solver` is automatic, chains and trees, and those of ropes and
  /// surfaces that shrink freely and for which `use` asks no passes; the rest of those it takes once their body is handed over, and
  /// others never.
  StretchNewton(const SpringNetwork& network, const StretchLimitSettings& settings, const LimitUse& use = {});
  ~StretchNewton();

  /// Leads free particles from where forces led them, `positions`, to where no limited spring is much too long, with as little
  /// weighted movement as that takes. `before` is where the step began; pins are where they shall be in `positions`. `fall` as
  /// ComponentSolver's; `holds` of bodies, or empty. Returns the most linear systems that a component took; none when nothing was
  /// too long.
  std::optional<int> solve(const Points& before, Points& positions, double fall, const std::vector<StretchHandover>& holds = {});

  /// Whether all limited springs of a body are solved for from the start.
  [[nodiscard]] bool holds(const Body& body) const;
  /// Whether there is anything that is or may be solved for.
  [[nodiscard]] bool takes_any() const { return !parts_.empty(); }
  [[nodiscard]] bool holds_all() const { return left_.empty(); }

  /// Whether any of a body, by its number, is solved for from the start, and whether more can be once it is handed over.
  [[nodiscard]] bool takes_any_of(std::size_t body) const;
  [[nodiscard]] bool may_take_over(std::size_t body) const;
  [[nodiscard]] bool may_take_over_any() const;

  /// The largest turn of a component in the last solve; see ComponentSolver. None is 0.
  [[nodiscard]] double turn() const;

 private:
  /// What is or may be solved for.
  struct Part {
    std::unique_ptr<ComponentSolver> solver;
    std::size_t body;
    bool from_start;
  };

  std::vector<Part> parts_;
  std::vector<Index> left_;  ///< particles that are not solved for from the start, in ascending order
};

}  // namespace sprung
