#include "dynamics/stretch_limit.h"

#include "base/parallel.h"
#include "dynamics/lane_count.h"
#include "dynamics/stretch_kernel.h"
#include "dynamics/stretch_load.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {
namespace {

// Cut by size alone; a thread is worth waking for some 10 us of work.
constexpr Index kSpringChunk = 4096;
static_assert(kSpringChunk % kSpringLanes == 0);

// A limit without play and without tolerance is never held quite: this is what steps are chosen for then.
constexpr double kLeastExcess = 1.0e-3;

/// Largest of what `excess_of(begin, end)` says of chunks of [begin, end).
template <class ExcessOf>
double largest_excess(Index begin, Index end, const ExcessOf& excess_of) {
  std::vector<double> excess((end - begin + kSpringChunk - 1) / kSpringChunk, 0.0);
  parallel_chunks(end - begin, kSpringChunk, [&](Index chunk_begin, Index chunk_end) {
    excess[chunk_begin / kSpringChunk] = excess_of(begin + chunk_begin, begin + chunk_end);
  });
  return excess.empty() ? 0.0 : *std::ranges::max_element(excess);
}

LengthRange length_range(const StretchLimitSettings& settings) {
  return {.least = 1.0 - settings.max_compression, .most = 1.0 + settings.max_stretch};
}

}  // namespace

StretchLimit::StretchLimit(const SpringNetwork& network, const StretchLimitSettings& settings)
    : network_(network), settings_(settings), batches_(std::make_unique<StretchBatches>(network, settings.kinds)) {}
StretchLimit::~StretchLimit() = default;

double StretchLimit::project(Points& positions) const {
  const LengthRange range = length_range(settings_);
  double excess = 0.0;
  for (std::size_t batch = 0; batch + 1 < batches_->begin.size(); ++batch) {
    const double of_batch = largest_excess(batches_->begin[batch], batches_->begin[batch + 1], [&](Index begin, Index end) {
      return project_springs(*batches_, begin, end, range, positions.data());
    });
    excess = std::max(excess, of_batch);
  }
  return excess;
}

double StretchLimit::excess(const Points& positions) const {
  const LengthRange range = length_range(settings_);
  return largest_excess(0, batches_->count(),
                        [&](Index begin, Index end) { return measure_springs(*batches_, begin, end, range, positions.data()); });
}

const StretchLimitSettings& StretchLimit::settings() const { return settings_; }

// At rest each step adds g dt^2 to each particle, and each of its passes hands on a part of it.
double StretchLimit::suggested_step(double acceleration) const {
  double load = 0.0;
  for (const Body& body : network_.bodies) load = std::max(load, largest_load(network_, body, *batches_));
  const double excess = std::max(0.5 * settings_.max_stretch + settings_.tolerance, kLeastExcess);
  const double divisor = acceleration * load;
  return divisor > 0.0 ? std::sqrt(excess * settings_.iterations / divisor) : std::numeric_limits<double>::infinity();
}

}  // namespace sprung
