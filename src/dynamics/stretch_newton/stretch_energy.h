// The objective of a global solve of the stretch limit.
#pragma once

#include "dynamics/stretch_newton/stretch_system.h"
#include "dynamics/tethers/stretch_limit_settings.h"

#include <cstdint>

namespace sprung {

/// How the linear system treats links that are shorter than their limit. A stiff link gets the stiffness of a link at its limit,
/// but no force.
enum class NearLimit : std::uint8_t {
  slack,     ///< without stiffness
  overshot,  ///< stiff if note_overshot() recorded them
  stiff,     ///< stiff if they are near the limit, see find_near()
  pushing    ///< near the limit they both pull and push
};

/// E(x) = 1/2 sum m |x - y|^2 + 1/2 sum k max(0, |d| - L)^2 over the free points and links of a component. y is the target of the
/// forces and L the largest length of a link. k = W / (e d) with the load W [kg m], the rest length d, and the relative excess e
/// of a link that carries all of W. Multiplied by 1 / dt^2 these are joules. A rod adds 1/2 k (|d| - L)^2, also when it is shorter
/// than its length L, with a stiffness at which it carries W within a tenth of its tolerance.
class StretchEnergy {
 public:
  /// Keeps a reference to the component.
  StretchEnergy(const StretchComponent& component, const StretchLimitSettings& settings);

  /// Sets the rods of the step, by number. Keeps a reference to them.
  void set_rods(std::span<const RodRow> rows) { rows_ = rows; }

  /// Sets the load W [kg m] > 0.
  void set_load(double load) { load_ = load; }

  /// The largest excess length of a link that carries the load [m].
  [[nodiscard]] double give() const { return give_; }

  /// Marks the links near their limit: those shorter by less than a tenth of it and, where springs or angle bends have stiffness,
  /// by less than half of the largest excess at the target `y`.
  void find_near(const Points& y);

  /// E at `x`; both 3 x points.
  [[nodiscard]] double value(const Points& x, const Points& y) const;

  /// Marks links that are too long at `x`: they are stiff with NearLimit::overshot until the marks are cleared.
  void note_overshot(const Points& x);
  void forget_overshot() { overshot_.clear(); }
  [[nodiscard]] bool knows_overshot() const { return !overshot_.empty(); }

  /// Computes E, its negative gradient (the residual) and its second derivatives without the parts that would make a block
  /// indefinite. The returned energy includes links near the limit that push.
  double linearise(const Points& x, const Points& y, NearLimit near, StretchSystem& system) const;

  /// The pull of each link at `x`, k max(0, |d| - L) [kg m], and the push of each rod on its first end [kg m].
  [[nodiscard]] std::vector<double> pulls(const Points& x) const;
  [[nodiscard]] Vector3 push(const StretchComponent::Rod& rod, const Points& x) const;

  /// For each link k max(0, 1 - L / |d|) at `x`: its contribution to the second derivatives across its direction [kg].
  [[nodiscard]] std::vector<double> stiffness_across(const Points& x) const;

  /// Replaces the residual by the forces that the linearisation at `x` missed on the step to `tried`: links that became longer
  /// because the step rotated them pull along their directions at `x`, at most by their excess at `tried`. This is a second-order
  /// correction (Nocedal and Wright 2006, chapter 18).
  void take_turning(const Points& x, const Points& tried, StretchSystem& system) const;

 private:
  /// A rod at some positions.
  struct RodState {
    Vector3 direction = Vector3::Zero();  ///< of the difference of its ends
    double distance;                      ///< between them [m]
    double excess;                        ///< of the distance over the length [m]
    double stiffness;                     ///< k [kg]
  };
  [[nodiscard]] RodState state_of(const StretchComponent::Rod& rod, const Points& x) const;
  void add_push(const StretchComponent::Rod& rod, const Vector3& push, StretchSystem& system) const;
  [[nodiscard]] double linearise_rods(const Points& x, StretchSystem& system) const;

  struct Limit {
    double length;     ///< L [m]
    double stiffness;  ///< k for a load of 1 kg m [1/m]
  };

  const StretchComponent& component_;
  std::span<const RodRow> rows_;
  std::vector<Limit> limits_;   ///< of links
  std::vector<char> overshot_;  ///< a flag per link; empty while none is marked
  double load_ = 0.0;
  double give_ = 0.0;
  double near_;  ///< links are near their limit from this fraction of it
};

}  // namespace sprung
