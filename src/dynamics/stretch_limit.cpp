#include "dynamics/stretch_limit.h"

#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace sprung {
namespace {

constexpr Index kSpringChunk = 2048;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

/// Limited springs, batch after batch.
struct StretchLimit::Batches {
  std::vector<Index> first;
  std::vector<Index> second;
  std::vector<double> rest_length;
  std::vector<Index> begin{0};  ///< batch b holds springs [begin[b], begin[b + 1])

  Batches(const SpringNetwork& network, const StretchLimitSettings& settings);
};

namespace {

std::vector<Index> limited_springs(const SpringNetwork& network, const StretchLimitSettings& settings) {
  const Springs& springs = network.springs;
  std::vector<Index> limited;
  for (Index s = 0; s < springs.count(); ++s) {
    const auto k = static_cast<std::size_t>(s);
    const bool held = std::find(settings.kinds.begin(), settings.kinds.end(), springs.kind[k]) != settings.kinds.end();
    const bool movable = !network.is_pinned(springs.first[k]) || !network.is_pinned(springs.second[k]);
    if (held && movable && springs.rest_length[k] > 0.0) limited.push_back(s);
  }
  return limited;
}

}  // namespace

// Greedy colouring in the springs' order, 64 colours a round; springs that find none wait for the next round.
StretchLimit::Batches::Batches(const SpringNetwork& network, const StretchLimitSettings& settings) {
  const Springs& springs = network.springs;
  std::vector<Index> waiting = limited_springs(network, settings);
  while (!waiting.empty()) {
    std::vector<std::uint64_t> used(static_cast<std::size_t>(network.particle_count()), 0);
    std::array<std::vector<Index>, 64> batches;
    std::vector<Index> left;
    for (const Index s : waiting) {
      std::uint64_t& at_a = used[static_cast<std::size_t>(springs.first[static_cast<std::size_t>(s)])];
      std::uint64_t& at_b = used[static_cast<std::size_t>(springs.second[static_cast<std::size_t>(s)])];
      const int colour = std::countr_one(at_a | at_b);
      if (colour == 64) {
        left.push_back(s);
        continue;
      }
      at_a |= std::uint64_t{1} << colour;
      at_b |= std::uint64_t{1} << colour;
      batches[static_cast<std::size_t>(colour)].push_back(s);
    }
    for (const std::vector<Index>& batch : batches) {
      if (batch.empty()) break;
      for (const Index s : batch) {
        const auto k = static_cast<std::size_t>(s);
        first.push_back(springs.first[k]);
        second.push_back(springs.second[k]);
        rest_length.push_back(springs.rest_length[k]);
      }
      begin.push_back(static_cast<Index>(first.size()));
    }
    waiting = std::move(left);
  }
}

StretchLimit::StretchLimit(const SpringNetwork& network, const StretchLimitSettings& settings)
    : network_(network), settings_(settings), batches_(new Batches(network, settings)) {}
StretchLimit::~StretchLimit() = default;

double StretchLimit::project(Points& positions) const {
  double largest = 0.0;
  for (std::size_t batch = 0; batch + 1 < batches_->begin.size(); ++batch) {
    const Index start = batches_->begin[batch];
    const Index count = batches_->begin[batch + 1] - start;
    std::vector<double> worst(static_cast<std::size_t>((count - 1) / kSpringChunk + 1), 0.0);
    parallel_chunks(count, kSpringChunk, [&](Index begin, Index end) {
      double& of_chunk = worst[static_cast<std::size_t>(begin / kSpringChunk)];
      for (auto s = static_cast<std::size_t>(start + begin); s < static_cast<std::size_t>(start + end); ++s) {
        const Index a = batches_->first[s];
        const Index b = batches_->second[s];
        const double rest = batches_->rest_length[s];
        const Vector3 between = positions.col(a) - positions.col(b);
        const double length = between.norm();
        const double allowed = std::clamp(length, rest * (1.0 - settings_.max_compression), rest * (1.0 + settings_.max_stretch));
        if (length == allowed || length == 0.0) continue;
        const double w_a = network_.inverse_masses[a];
        const double w_b = network_.inverse_masses[b];
        const Vector3 correction = ((length - allowed) / (length * (w_a + w_b))) * between;
        positions.col(a) -= w_a * correction;
        positions.col(b) += w_b * correction;
        of_chunk = std::max(of_chunk, std::abs(length - allowed) / rest);
      }
    });
    for (const double w : worst) largest = std::max(largest, w);
  }
  return largest;
}

double StretchLimit::excess(const Points& positions) const {
  double largest = 0.0;
  for (std::size_t s = 0; s < batches_->first.size(); ++s) {
    const double rest = batches_->rest_length[s];
    const double length = (positions.col(batches_->first[s]) - positions.col(batches_->second[s])).norm();
    largest = std::max({largest, length / rest - 1.0 - settings_.max_stretch, 1.0 - settings_.max_compression - length / rest});
  }
  return largest;
}

const StretchLimitSettings& StretchLimit::settings() const { return settings_; }

// At rest each pass hands g dt^2 per particle on towards the pins. What waits at a pin after `iterations` passes is about
// 2 g dt^2 carried / (iterations d), which may be half the limit.
double StretchLimit::suggested_step(double acceleration) const {
  if (batches_->first.empty() || acceleration == 0.0) return kInfinity;
  double weakest = kInfinity;
  for (const Body& body : network_.bodies) {
    double carried = 0.0;
    double bearers = 0.0;
    double rest = kInfinity;
    for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i)
      carried += network_.is_pinned(i) ? 0 : 1;
    for (std::size_t s = 0; s < batches_->first.size(); ++s) {
      const Index a = batches_->first[s];
      if (a < body.first_particle || a >= body.first_particle + body.particle_count) continue;
      rest = std::min(rest, batches_->rest_length[s]);
      if (network_.is_pinned(a) || network_.is_pinned(batches_->second[s])) bearers += 1.0;
    }
    if (rest == kInfinity) continue;
    const double load = bearers > 0.0 ? carried / bearers : std::sqrt(carried);
    weakest = std::min(weakest, rest * settings_.iterations / load);
  }
  return std::sqrt((0.5 * settings_.max_stretch + settings_.tolerance) * weakest / (2.0 * acceleration));
}

}  // namespace sprung
