#include "dynamics/stretch_limit.h"

#include "base/parallel.h"
#include "dynamics/limited_springs.h"
#include "dynamics/stretch_kernel.h"
#include "dynamics/stretch_load.h"
#include "dynamics/stretch_newton.h"
#include "dynamics/tether_paths.h"
#include "dynamics/tethers.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {
namespace {

// Cut by size alone; a thread is worth waking for some 10 us of work.
constexpr Index kPartChunk = 4096 / StretchBatches::kPartSprings;

// A limit without play and without tolerance is never held quite: this is what steps are chosen for then.
constexpr double kLeastExcess = 1.0e-3;

// Springs that may shrink by no more than this part of the excess hardly let a surface neck.
constexpr double kLeastPlay = 0.1;

/// Largest of what `excess_of` says of parts [begin, end).
template <class ExcessOf>
double largest_excess(const StretchBatches& batches, Index begin, Index end, const ExcessOf& excess_of) {
  std::vector<double> excess((end - begin + kPartChunk - 1) / kPartChunk, 0.0);
  parallel_chunks(end - begin, kPartChunk, [&](Index chunk_begin, Index chunk_end) {
    double& largest = excess[chunk_begin / kPartChunk];
    for (Index p = begin + chunk_begin; p < begin + chunk_end; ++p) largest = std::max(largest, excess_of(batches.parts[p]));
  });
  return excess.empty() ? 0.0 : *std::ranges::max_element(excess);
}

LengthRange length_range(const StretchLimitSettings& settings) {
  return {.least = 1.0 - settings.max_compression, .most = 1.0 + settings.max_stretch};
}

}  // namespace

StretchLimit::StretchLimit(const SpringNetwork& network, const StretchLimitSettings& settings)
    : network_(network), settings_(settings), batches_(std::make_unique<StretchBatches>(network, settings.kinds)) {
  if (settings.tethers) tethers_ = std::make_unique<Tethers>(network, settings.kinds, settings.max_stretch);
  if (settings.solver != StretchLimitSettings::Solver::gauss_seidel) newton_ = std::make_unique<StretchNewton>(network, settings);
}
StretchLimit::~StretchLimit() = default;

double StretchLimit::project(Points& positions, double relaxation) const {
  if (tethers_) tethers_->project(positions);
  const LengthRange range = length_range(settings_);
  const auto project_part = [&](const StretchBatches::Part& part) {
    return project_springs(*batches_, part, range, relaxation, positions.data());
  };
  double excess = 0.0;
  for (std::size_t batch = 0; batch + 1 < batches_->begin.size(); ++batch) {
    excess = std::max(excess, largest_excess(*batches_, batches_->begin[batch], batches_->begin[batch + 1], project_part));
  }
  return excess;
}

std::optional<int> StretchLimit::solve(const Points& before, Points& positions, double fall) const {
  return newton_ ? newton_->solve(before, positions, fall) : std::nullopt;
}

double StretchLimit::excess(const Points& positions) const {
  const LengthRange range = length_range(settings_);
  return largest_excess(*batches_, 0, batches_->begin.back(), [&](const StretchBatches::Part& part) {
    return measure_springs(*batches_, part, range, positions.data());
  });
}

const StretchLimitSettings& StretchLimit::settings() const { return settings_; }

std::string StretchLimit::chosen_solver() const {
  if (!newton_ || !newton_->holds_any()) return "gauss_seidel";
  return newton_->holds_all() ? "newton" : "newton for chains and trees, gauss_seidel for the rest";
}

// At rest each step adds g dt^2 to each particle, and each of its passes hands on a part of it. Where tethers have handed on
// theirs, passes gain less: hanging cloths showed 4 passes to be worth 2.6, and 32 to be worth 10. Where springs may
// not shrink either, over-relaxed passes gain more: 2, 4, 8 and 32 were worth 2, 10, 29 and 280. What sags between its pins hangs
// askew from all of them: there tethers gain nothing.
double StretchLimit::suggested_step(double acceleration) const {
  const SpringGraph graph(network_, limited_springs(network_, settings_.kinds));
  const std::vector<Tether> tethers = settings_.tethers ? find_tethers(network_, settings_.kinds) : std::vector<Tether>{};
  const double excess = std::max(0.5 * settings_.max_stretch + settings_.tolerance, kLeastExcess);
  const double passes = settings_.iterations;
  const auto gained_by = [&](const Body& body) {
    const bool shared = settings_.max_compression <= kLeastPlay * excess && holds_shape(body, graph);
    const double alone = largest_load(network_, body, graph, {.tethers = false, .shared = shared}) / passes;
    if (!are_pins_taut(network_, body, tethers, settings_.max_stretch)) return alone;
    const double worth = shared ? 1.0 + std::pow(passes - 1.0, 1.5) : std::cbrt(passes * passes);
    return std::min(alone, largest_load(network_, body, graph, {.tethers = true, .shared = shared}) / worth);
  };
  double smallest = std::numeric_limits<double>::infinity();
  for (const Body& body : network_.bodies) {
    if (newton_ && newton_->holds(body) && settings_.max_compression == 1.0) continue;
    const double gained = acceleration * gained_by(body);
    if (gained > 0.0) smallest = std::min(smallest, std::sqrt(excess / gained));
  }
  return smallest;
}

}  // namespace sprung
