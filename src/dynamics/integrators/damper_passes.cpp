#include "dynamics/integrators/damper_passes.h"

#include "dynamics/integrators/schemes.h"
#include "dynamics/state/simulation_state.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace sprung {
namespace {

// Between its roots, the Chebyshev polynomial of the two series is at most about (1 + kDecay)^-2: what is fast for a step loses a
// third of its speed or more. A smaller number bears a little more damping, but leaves some of the fast modes undamped.
constexpr double kDecay = 0.2;

constexpr int kMostOfSeries = kMostDamperSteps / 2;

/// The argument beyond 1 that stands for an undamped mode.
double shift_of(int steps) { return 1.0 + kDecay / (steps * steps); }

/// 1 / (shift - root) of the k-th root of the Chebyshev polynomial: the lengths are in proportion to it.
double length_of(int k, int steps) { return 1.0 / (shift_of(steps) - std::cos(std::numbers::pi * (k + 0.5) / steps)); }

double sum_of_lengths(int steps) {
  double sum = 0.0;
  for (int k = 0; k < steps; ++k) sum += length_of(k, steps);
  return sum;
}

/// The largest rate times dt / 2 for which the series is stable: where the argument is -1.
double borne(int steps) { return (shift_of(steps) + 1.0) * sum_of_lengths(steps); }

}  // namespace

std::vector<double> damper_steps(double dt, double rate) {
  int steps = 1;
  while (steps < kMostOfSeries && borne(steps) < 0.5 * dt * rate) ++steps;
  std::vector<double> lengths;
  const double scale = 0.5 * dt / sum_of_lengths(steps);
  for (int k = steps - 1; k >= 0; --k) lengths.push_back(scale * length_of(k, steps));
  return lengths;
}

double most_damping_rate(double dt) { return 2.0 * borne(kMostOfSeries) / dt; }

void DamperPasses::set(Forces dampers, double rate) {
  dampers_ = std::move(dampers);
  rate_ = rate;
}

void DamperPasses::apply(const Points& x, double dt, SimulationState& state) {
  if (empty()) return;
  const std::vector<double> lengths = damper_steps(dt, rate_);
  const double time = step_begin(state, dt);
  for (int series = 0; series < 2; ++series) {
    for (const double length : lengths) {
      sum_forces(dampers_, {.x = x, .v = state.v, .time = time}, total_);
      for_particles(network_, [&](Index i) {
        if (!network_.is_fixed(i)) {
          state.v.col(i) += length * network_.inverse_masses[i] * total_.col(i);
        } else if (state.impulses.on()) {
          state.impulses.on_pinned.col(i) += length * total_.col(i);
        }
      });
    }
  }
}

}  // namespace sprung
