// Springs and angle bends, as arrays.
#pragma once

#include "base/types.h"

#include <array>
#include <limits>
#include <vector>

namespace sprung {

enum class SpringKind : std::uint8_t { structural, shear, bend };
inline constexpr std::array<const char*, 3> kSpringKindNames{"structural", "shear", "bend"};  ///< in the order of the kinds

/// What a spring does besides to pull and push in proportion to its strain, (length - rest length) / rest length. By default
/// nothing.
struct SpringLaw {
  bool tension_only = false;  ///< a spring that is not longer than at rest has no force, neither elastic nor of its damper
  /// Perfect plasticity: after each step, a spring with a larger strain, stretched or compressed, gets the rest length at which
  /// the strain is this one. > 0
  double yield = std::numeric_limits<double>::infinity();
  double break_length = std::numeric_limits<double>::infinity();  ///< longer springs break [m], > 0

  [[nodiscard]] bool yields() const { return yield < std::numeric_limits<double>::infinity(); }
  [[nodiscard]] bool breaks() const { return break_length < std::numeric_limits<double>::infinity(); }
  [[nodiscard]] bool operator==(const SpringLaw&) const = default;
};

/// Springs as arrays; entry s of each array belongs to spring s. Within a body they are sorted by (second - first, first), so that
/// neighbours in a lattice make contiguous runs.
struct Springs {
  std::vector<Index> first;         ///< particle at one end, the lower index
  std::vector<Index> second;        ///< particle at the other end
  std::vector<double> rest_length;  ///< d [m], >= 0
  std::vector<double> stiffness;    ///< k_s [N/m], >= 0
  std::vector<double> damping;      ///< k_d [N s/m], >= 0
  std::vector<SpringKind> kind;
  std::vector<SpringLaw> laws{};  ///< empty if all are the default

  [[nodiscard]] Index count() const { return static_cast<Index>(first.size()); }
  [[nodiscard]] SpringLaw law(Index spring) const { return laws.empty() ? SpringLaw() : laws[spring]; }
  /// Adds a spring; sorts its two ends.
  void append(Index a, Index b, double rest, double k_s, double k_d, SpringKind spring_kind, const SpringLaw& law = {});
};

/// Until when springs at a particle wait for the waves of breaks [s], see unloading.h; 0 before the first break of the body.
struct Unloading {
  double by_all = 0.0;      ///< the fronts of all breaks of the body
  double by_near = 0.0;     ///< the fronts of breaks a few springs away
  double by_recoil = 0.0;   ///< the recoil after all breaks
  bool is_at_tear = false;  ///< whether a spring broke beside it

  [[nodiscard]] bool operator==(const Unloading&) const = default;
};

/// What steps change of springs, in the order of the springs at time 0.
struct SpringState {
  std::vector<double> rest_lengths{};  ///< [m]; empty unless a spring may yield
  std::vector<char> broken{};          ///< whether each is gone; empty unless a spring may break
  std::vector<Unloading> unloading{};  ///< of each particle; empty before the first break

  [[nodiscard]] bool is_broken(Index spring) const { return !broken.empty() && broken[spring] != 0; }
  [[nodiscard]] Index broken_count() const;
  [[nodiscard]] bool operator==(const SpringState&) const = default;
};

/// The state at time 0.
[[nodiscard]] SpringState initial_springs(const Springs& springs);

/// Elements that keep three particles in line, as arrays; entry a of each array belongs to element a. The bond middle - after
/// deviates from the direction of the bond before - middle by an angle theta, from 0 (in line) to pi (folded back). The energy is
/// 1/2 k theta^2 [J].
struct AngleBends {
  std::vector<Index> before;
  std::vector<Index> middle;
  std::vector<Index> after;
  std::vector<double> length_before;  ///< rest lengths of the bonds [m], > 0
  std::vector<double> length_after;
  std::vector<double> stiffness;  ///< k [N m/rad], >= 0
  std::vector<double> damping;    ///< of the rate of theta [N m s], >= 0

  [[nodiscard]] Index count() const { return static_cast<Index>(middle.size()); }
  /// Particles and bond lengths in the order before, middle, after.
  void append(const std::array<Index, 3>& particles, const std::array<double, 2>& lengths, double k, double k_d);
};

}  // namespace sprung
