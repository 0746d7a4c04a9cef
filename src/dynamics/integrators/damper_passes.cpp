#include "dynamics/integrators/damper_passes.h"

#include "dynamics/integrators/schemes.h"
#include "dynamics/state/simulation_state.h"

#include <cmath>
#include <utility>

namespace sprung {
namespace {

// T_s(w0): the polynomial at a rate of zero. A larger value damps fast modes more, but lowers the largest stable rate. For 2, 5 and
// 10, a step leaves at most 0.87, 0.75 and 0.69 of fast modes; 16 passes are stable up to a rate of 85 / dt, 69 / dt and 59 / dt.
constexpr double kAtZero = 5.0;
// Fast modes have |T_s| <= 1: P lies between (kOffset - 1) / kSum = 0.62 and (kOffset + 1) / kSum = 0.75. The first is required.
constexpr double kOffset = 10.8;
constexpr double kSum = kAtZero + kOffset;

/// w0: the argument at which T_s is kAtZero.
double argument_of(int passes) { return std::cosh(std::acosh(kAtZero) / passes); }

/// w1 of a step of one second, for which P has the derivative -1 at a rate of zero: kSum / T_s'(w0).
double slope_of(int passes) {
  const double growth = std::acosh(kAtZero) / passes;
  return kSum * std::sinh(growth) / (passes * std::sinh(std::acosh(kAtZero)));
}

/// The largest rate times dt for which the passes are stable: where the argument is -1.
double stable_limit(int passes) { return (argument_of(passes) + 1.0) / slope_of(passes); }

/// Sets DamperPass::impulse, from the last pass to the first: a change of v_j changes v* by `here` times the change.
void set_impulses(DamperSeries& series) {
  double of_next = 0.0;
  double here = series.share;
  for (std::size_t j = series.passes.size(); j-- > 0;) {
    series.passes[j].impulse = here * series.passes[j].gain;
    const double of_second_next = std::exchange(of_next, here);
    here = series.passes[j].last * of_next;
    if (j + 1 < series.passes.size()) here += series.passes[j + 1].second_last * of_second_next;
  }
}

}  // namespace

double DamperSeries::factor(double rate) const {
  double last = 1.0;
  double second_last = 0.0;
  for (const DamperPass& pass : passes) {
    second_last = std::exchange(last, (pass.last - pass.gain * rate) * last + pass.second_last * second_last);
  }
  return share * last + 1.0 - share;
}

DamperSeries damper_series(double dt, double rate) {
  int count = 1;
  while (count < kMostDamperPasses && stable_limit(count) < dt * rate) ++count;
  const double argument = argument_of(count);
  const double slope = slope_of(count) * dt;
  DamperSeries series{.passes = {{.last = 1.0, .second_last = 0.0, .gain = slope / argument}}, .share = kAtZero / kSum};
  double last = argument;  // T_(j-1)(w0)
  double second_last = 1.0;
  while (static_cast<int>(series.passes.size()) < count) {
    const double next = 2.0 * argument * last - second_last;
    series.passes.push_back(
        {.last = 2.0 * argument * last / next, .second_last = -second_last / next, .gain = 2.0 * slope * last / next});
    second_last = std::exchange(last, next);
  }
  set_impulses(series);
  return series;
}

double most_damping_rate(double dt) { return stable_limit(kMostDamperPasses) / dt; }

void DamperPasses::set(Forces dampers, double rate) {
  dampers_ = std::move(dampers);
  rate_ = rate;
}

void DamperPasses::apply(const Points& x, double dt, SimulationState& state) {
  if (empty()) return;
  const DamperSeries series = damper_series(dt, rate_);
  const double time = step_begin(state, dt);
  first_ = state.v;
  second_last_ = state.v;
  for (const auto& damper : dampers_) damper->hold(x);
  for (const DamperPass& pass : series.passes) {
    sum_forces(dampers_, {.x = x, .v = state.v, .time = time}, total_);
    for_particles(network_, [&](Index i) {
      if (!network_.is_fixed(i)) {
        const Vector3 last = state.v.col(i);
        state.v.col(i) =
            pass.last * last + pass.second_last * second_last_.col(i) + pass.gain * network_.inverse_masses[i] * total_.col(i);
        second_last_.col(i) = last;
      } else if (state.impulses.on()) {
        state.impulses.on_pinned.col(i) += pass.impulse * total_.col(i);
      }
    });
  }
  for_free_particles(network_,
                     [&](Index i) { state.v.col(i) = series.share * state.v.col(i) + (1.0 - series.share) * first_.col(i); });
}

}  // namespace sprung
