// A stretch limit by global solves: springs that hang together are brought within it all at once.
#pragma once

#include "dynamics/stretch_limit.h"

#include <memory>
#include <optional>
#include <vector>

namespace sprung {

class ComponentNewton;

/// Newton's method on each component of limited springs: chains and trees by elimination, others by a sparse factor. Only
/// max_stretch is held, not max_compression. Same bits for any number of threads. Of what is not a chain or a tree a step's later
/// digits depend on the steps before, whose factors it may use: the same steps one after the other have the same bits.
class StretchNewton {
 public:
  /// Takes chains and trees alone when `settings.solver` is automatic.
  StretchNewton(const SpringNetwork& network, const StretchLimitSettings& settings);
  ~StretchNewton();

  /// Leads free particles from where forces led them, `positions`, to where no limited spring is much too long, with as little
  /// weighted movement as that takes. `before` is where the step began; pins are where they shall be in `positions`. `fall` as
  /// ComponentNewton's. Returns the most linear systems that a component took; none when nothing was too long.
  std::optional<int> solve(const Points& before, Points& positions, double fall);

  /// Whether all limited springs of a body are solved for.
  [[nodiscard]] bool holds(const Body& body) const;
  [[nodiscard]] bool holds_any() const { return !components_.empty(); }
  [[nodiscard]] bool holds_all() const { return left_.empty(); }

  /// The largest turn of a component in the last solve; see ComponentNewton. None is 0.
  [[nodiscard]] double turn() const;

 private:
  std::vector<std::unique_ptr<ComponentNewton>> components_;
  std::vector<Index> left_;  ///< particles that are not solved for, in ascending order
};

}  // namespace sprung
