#include "dynamics/air/wind.h"

#include "base/parallel.h"
#include "geometry/motion/keyframe_span.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace sprung {
namespace {

constexpr Index kParticleChunk = 1024;

}  // namespace

Wind::Wind(std::vector<WindKeyframe> keyframes, const std::optional<Gusts>& gusts)
    : keyframes_(std::move(keyframes)), gusts_(gusts) {
  if (gusts_ && gusts_->speed > 0.0) field_.emplace(*gusts_);
}

bool Wind::is_calm() const {
  return !field_ && std::ranges::all_of(keyframes_, [](const WindKeyframe& key) { return key.velocity.isZero(0.0); });
}

Vector3 Wind::mean(double time) const {
  if (keyframes_.empty()) return Vector3::Zero();
  const auto [before, after, w] = span_at(keyframes_, time);
  const Vector3& a = keyframes_[before].velocity;
  if (before == after) return a;
  return (1.0 - w) * a + w * keyframes_[after].velocity;
}

/// The integral of the mean wind from time 0. It is linear between keyframes, so the trapezoidal rule is exact there.
Vector3 Wind::mean_path(double time) const {
  const double begin = std::min(0.0, time);
  const double end = std::max(0.0, time);
  Vector3 path = Vector3::Zero();
  double last = begin;
  const auto go_to = [&](double next) {
    path += 0.5 * (next - last) * (mean(last) + mean(next));
    last = next;
  };
  for (const WindKeyframe& key : keyframes_) {
    if (key.time > begin && key.time < end) go_to(key.time);
  }
  go_to(end);
  return time < 0.0 ? Vector3(-path) : path;
}

Vector3 Wind::velocity(const Vector3& position, double time) const {
  Points velocity = mean(time);
  if (field_) field_->add_velocities(position, mean_path(time), time, velocity);
  return velocity;
}

Points Wind::velocities(const Points& positions, double time) const {
  Points velocities = mean(time).replicate(1, positions.cols());
  if (!field_) return velocities;
  const Vector3 path = mean_path(time);
  parallel_chunks(static_cast<Index>(positions.cols()), kParticleChunk, [&](Index begin, Index end) {
    field_->add_velocities(positions.middleCols(begin, end - begin), path, time, velocities.middleCols(begin, end - begin));
  });
  return velocities;
}

double Wind::end() const {
  if (field_) return std::numeric_limits<double>::infinity();
  const auto differs = [](const WindKeyframe& a, const WindKeyframe& b) { return a.velocity != b.velocity; };
  const bool changes = std::adjacent_find(keyframes_.begin(), keyframes_.end(), differs) != keyframes_.end();
  return changes ? keyframes_.back().time : 0.0;
}

double Wind::strongest_mean() const {
  double strongest = 0.0;
  for (const WindKeyframe& key : keyframes_) strongest = std::max(strongest, key.velocity.norm());
  return strongest;
}

double Wind::max_speed() const { return strongest_mean() + (field_ ? field_->max_speed() : 0.0); }

double Wind::usual_speed() const { return strongest_mean() + (field_ ? 2.0 * gusts_->speed : 0.0); }

}  // namespace sprung
