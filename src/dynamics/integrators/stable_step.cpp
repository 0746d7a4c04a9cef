#include "dynamics/integrators/stable_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The positive root of k dt^2 + 2 c dt = limit.
double positive_root(double k, double c, double limit) {
  const double divisor = c + std::sqrt(c * c + k * limit);
  return divisor > 0.0 ? limit / divisor : kInfinity;
}

struct LargestStep {
  double elastic;
  double damping;

  // z^2 - (2 - c dt) z + 1 - c dt + k dt^2 is positive at z = -1 below 2 / c, whatever fraction of the stiffness the damped mode
  // has.
  double operator()(const ExplicitEulerSettings&) const {
    const double rate = std::max(std::sqrt(elastic), damping);
    return rate > 0.0 ? 2.0 / rate : kInfinity;
  }

  // z^2 - (2 - c dt - k dt^2) z + 1 - c dt is stable while its value at z = -1 is positive.
  double operator()(const SymplecticEulerSettings&) const { return positive_root(elastic, damping, 4.0); }

  // The same with z^2 - (2 - d - c dt - k dt^2) z + 1 - d - c dt. Here d may depend on the step, and 4 - 2 d decreases with it, so
  // the bound is where the two curves meet.
  double operator()(const VerletSettings& verlet) const {
    double unstable = positive_root(elastic, damping, 4.0 - 2.0 * damping_per_step(verlet, 0.0));
    if (!(verlet.damping_rate > 0.0) || unstable == kInfinity) return unstable;
    double stable = positive_root(elastic, damping, 4.0 - 2.0 * damping_per_step(verlet, unstable));
    for (int halving = 0; halving < std::numeric_limits<double>::digits; ++halving) {
      const double middle = 0.5 * (stable + unstable);
      const double limit = positive_root(elastic, damping, 4.0 - 2.0 * damping_per_step(verlet, middle));
      (middle < limit ? stable : unstable) = middle;
    }
    return stable;
  }

  // With E = 1 - C/2, C = dt L_d, a mode x z^n has (z - 1)^2 E^2 (z - (1 + z) C / 4)^-1 x + (z - 1) C x + dt^2 K x = 0. For z = e^i
  // phi the quadratic form of the first two terms has the imaginary part of sin phi throughout, whatever C does to x: a mode can
  // leave the unit circle only at z = -1, where dt^2 k = 4 - 2 c + c^2 for some mixture of c <= dt l_D < 2; that is least at c = 1.
  double operator()(const VelocityVerletSettings&) const {
    if (elastic >= 3.0 * damping * damping) return positive_root(elastic - damping * damping, damping, 4.0);
    return std::min(std::sqrt(3.0 / elastic), 2.0 / damping);
  }

  // Its modes are R(s dt), R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24, for roots s of s^2 + c s + k with some c <= l_D and k <= l_K:
  // real ones down to -l_D, and complex ones as large as sqrt(l_K) with real parts down to -l_D / 2. |R| <= 1 holds down to -2.785
  // on the real axis, for |z| <= 2.828 where the real part is within -0.85 and 0, and for |z| <= 2.615 in all of the left half
  // plane.
  double operator()(const RungeKutta4Settings&) const {
    const double omega = std::sqrt(elastic);
    if (omega == 0.0 && damping == 0.0) return kInfinity;
    const double slightly_damped = std::min(2.828 / omega, 1.7 / damping);
    return std::min(std::max(slightly_damped, 2.615 / omega), 2.785 / damping);
  }

  // It multiplies the energy of a mode by at most 1 / (1 + c dt + k dt^2).
  double operator()(const ImplicitEulerSettings&) const { return kInfinity; }
};

}  // namespace

double largest_stable_step(const IntegratorSettings& settings, const SpectralBounds& bounds) {
  const double damping = may_split_dampers(settings) ? bounds.damping : with_all_dampers(bounds).damping;
  return std::visit(LargestStep{bounds.elastic, damping}, settings);
}

bool may_split_dampers(const IntegratorSettings& settings) {
  return !std::holds_alternative<ExplicitEulerSettings>(settings) && !std::holds_alternative<ImplicitEulerSettings>(settings);
}

SpectralBounds with_all_dampers(const SpectralBounds& bounds) {
  SpectralBounds all = bounds;
  all.damping = std::max(bounds.damping, bounds.all_damping);
  all.material_damping = 0.0;
  return all;
}

// A period of n steps has omega dt = 2 sin(pi / n).
double resonant_step(const IntegratorSettings& settings, const SpectralBounds& bounds) {
  const bool leaps = !std::holds_alternative<ExplicitEulerSettings>(settings) &&
                     !std::holds_alternative<RungeKutta4Settings>(settings) &&
                     !std::holds_alternative<ImplicitEulerSettings>(settings);
  if (!leaps || bounds.undamped == 0.0) return kInfinity;
  const double step = 1.0 / std::sqrt(bounds.undamped);
  const auto* verlet = std::get_if<VerletSettings>(&settings);
  const bool damps = verlet != nullptr && damping_per_step(*verlet, step) >= 2.0 * kHardlyDamped;
  return damps ? kInfinity : step;
}

// |1 + s dt|^2 = 1 - c dt + k dt^2 for the roots s of s^2 + c s + k. Dampers give the fastest mode at least c = damping_time k.
double growth_time(const IntegratorSettings& settings, const SpectralBounds& bounds, double step) {
  if (!std::holds_alternative<ExplicitEulerSettings>(settings)) return kInfinity;
  const double rate = bounds.elastic * (step - bounds.damping_time) - bounds.least_drag;
  return rate > 0.0 ? 2.0 / rate : kInfinity;
}

double step_for_growth_time(const IntegratorSettings& settings, const SpectralBounds& bounds, double time) {
  if (!std::holds_alternative<ExplicitEulerSettings>(settings) || bounds.elastic == 0.0) return kInfinity;
  return bounds.damping_time + (2.0 / time + bounds.least_drag) / bounds.elastic;
}

}  // namespace sprung
