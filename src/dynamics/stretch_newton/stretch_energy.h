// What a global solve of a stretch limit minimises.
#pragma once

#include "dynamics/stretch_newton/stretch_system.h"
#include "dynamics/tethers/stretch_limit_settings.h"

#include <cstdint>

namespace sprung {

/// What links count as that are shorter than the longest they may be. Stiff ones are as stiff as those that are too long, though
/// they neither pull nor push.
enum class NearLimit : std::uint8_t {
  slack,     ///< what they are
  overshot,  ///< stiff where note_overshot() was told of them
  stiff,     ///< stiff where they are near it, as find_near() has it
  pushing    ///< near it as if they held both ways
};

/// E(x) = 1/2 sum m |x - y|^2 + 1/2 sum k max(0, |d| - L)^2 over free points and links of a component: y is where forces led, L the
/// longest a link may be, and k = W / (e d) for what the links carry, W [kg m], the rest length d and the part of it, e, by which a
/// link that carries all of W is longer than L. Times 1 / dt^2 these are joules.
class StretchEnergy {
 public:
  /// Keeps a reference to the component.
  StretchEnergy(const StretchComponent& component, const StretchLimitSettings& settings);

  /// Requires weight > 0. [kg m]
  void set_weight(double weight) { weight_ = weight; }

  /// How much longer than its longest a link is that carries the weight, at most [m].
  [[nodiscard]] double give() const { return give_; }

  /// Links are near their limit that are shorter by less than a tenth of it; where springs or angle bends have stiffness, after
  /// this also by less than half of what the longest is too long at `y`, where forces led.
  void find_near(const Points& y);

  /// E at `x`; both 3 x points.
  [[nodiscard]] double value(const Points& x, const Points& y) const;

  /// Links that are too long at `x` are stiff with NearLimit::overshot until all are forgotten.
  void note_overshot(const Points& x);
  void forget_overshot() { overshot_.clear(); }
  [[nodiscard]] bool knows_overshot() const { return !overshot_.empty(); }

  /// E, its negative gradient as the residual, and its second derivatives, of which those are left out that would make a block
  /// indefinite. What links near the limit count as if they pushed is in what is returned too.
  double linearise(const Points& x, const Points& y, NearLimit near, StretchSystem& system) const;

  /// Of each link k max(0, 1 - L / |d|) at `x`, what its pull adds to the second derivatives across it [kg].
  [[nodiscard]] std::vector<double> stiffness_across(const Points& x) const;

  /// What links pull on the way from `x`, where the system is linearised, to `tried` that it does not know of: as much as turning
  /// made them longer, along their directions at `x`; links that count and are too long at `tried`, at most by that. Replaces the
  /// residual: the step of a second-order correction (Nocedal and Wright 2006, chapter 18).
  void take_turning(const Points& x, const Points& tried, StretchSystem& system) const;

 private:
  struct Limit {
    double length;     ///< L [m]
    double stiffness;  ///< k for a weight of 1 [1/m]
  };

  const StretchComponent& component_;
  std::vector<Limit> limits_;   ///< of links
  std::vector<char> overshot_;  ///< links; empty while none is known
  double weight_ = 0.0;
  double give_ = 0.0;
  double near_;  ///< the part of their limit from which links are near it
};

}  // namespace sprung
