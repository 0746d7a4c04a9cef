#include "dynamics/attachments/rods.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

constexpr double kTolerance = 5.0e-4;
constexpr Index kRodsPerChunk = 128;

// A rod that turns farther than 60 degrees in a step moves along its present line instead of the former one.
constexpr double kLeastCosine = 0.5;

/// The vector by which the difference of the ends has to change so that its length is `length`, along `line`.
Vector3 change_along(const Vector3& line, const Vector3& difference, double length) {
  const double along = line.dot(difference);
  const double root = along * along - difference.squaredNorm() + length * length;
  return (length * length - difference.squaredNorm()) / (along + std::sqrt(root)) * line;
}

Vector3 change_of(const Vector3& before, const Vector3& difference, double length) {
  const double distance = difference.norm();
  const double distance_before = before.norm();
  if (length > 0.0 && distance_before > 0.0) {
    const Vector3 line = before / distance_before;
    const double along = line.dot(difference);
    const bool reaches = along * along - distance * distance + length * length >= 0.0;
    if (reaches && along > kLeastCosine * distance) return change_along(line, difference, length);
  }
  return distance > 0.0 ? Vector3((length / distance - 1.0) * difference) : Vector3(Vector3::Zero());
}

}  // namespace

double length_at(const Link& link, double time) {
  const double left = 1.0 - std::clamp((time - link.time) / kWinchTime, 0.0, 1.0);
  return link.length + (link.distance - link.length) * (left * left * (3.0 - 2.0 * left));
}

Rods::Rods(const SpringNetwork& network, const std::vector<Obstacle>& obstacles)
    : network_(network), obstacles_(obstacles), joint_tolerance_(kTolerance * mean_spring_length(network)) {}

void Rods::load(const std::vector<Link>& links, double time) {
  rods_.clear();
  rows_.clear();
  for (std::size_t k = 0; k < links.size(); ++k) {
    if (links[k].broken || !network_.attachments[links[k].attachment].is_rigid()) continue;
    const LinkEnds ends(network_, obstacles_, links[k]);
    rods_.push_back({.number = k, .ends = ends, .link = links[k], .inverse_mass = ends.inverse_mass(network_.inverse_masses)});
    RodRow& row = rows_.emplace_back();
    for (const Index particle : ends.particles()) {
      row.weights[row.count] = ends.weight(row.count);
      row.particles[row.count++] = particle;
    }
  }
  colouring_ = colour_groups(rods_.size(), network_.particle_count(), [&](std::size_t r) { return rods_[r].ends.particles(); });
  prepare(time);
}

void Rods::prepare(double time) {
  for (std::size_t r = 0; r < rods_.size(); ++r) {
    Rod& rod = rods_[r];
    rod.anchor = rod.ends.anchor(time);
    rod.length = length_at(rod.link, time);
    rod.tolerance = rod.length > 0.0 ? kTolerance * rod.length : joint_tolerance_;
    rows_[r].anchor = rod.anchor;
    rows_[r].length = rod.length;
    rows_[r].tolerance = rod.tolerance;
  }
  pushes_.assign(rods_.size(), Vector3::Zero());
}

double Rods::project(const Points& before, Points& positions, const ImpulseRecorder& recorder) const {
  std::vector<double> violations(rods_.size(), 0.0);
  for (std::size_t c = 0; c + 1 < colouring_.colour_begin.size(); ++c) {
    const std::size_t first = colouring_.colour_begin[c];
    parallel_chunks(static_cast<Index>(colouring_.colour_begin[c + 1] - first), kRodsPerChunk, [&](Index begin, Index end) {
      for (std::size_t k = first + begin; k < first + end; ++k)
        violations[k] = project(colouring_.order[k], before, positions, recorder);
    });
  }
  return violations.empty() ? 0.0 : std::ranges::max(violations);
}

/// Returns the violation before.
double Rods::project(std::size_t number, const Points& before, Points& positions, const ImpulseRecorder& recorder) const {
  const Rod& rod = rods_[number];
  if (rod.inverse_mass == 0.0) return 0.0;
  const Vector3 difference = rod.ends.sum(positions) - rod.anchor;
  const Vector3 push = change_of(rod.ends.sum(before) - rod.anchor, difference, rod.length) / rod.inverse_mass;
  for (std::size_t k = 0; k < rod.ends.particles().size(); ++k) {
    const Index particle = rod.ends.particles()[k];
    positions.col(particle) += rod.ends.weight(k) * network_.inverse_masses[particle] * push;
    if (recorder.on() && network_.is_fixed(particle)) recorder.add_to_pinned(particle, rod.ends.weight(k) * push);
  }
  pushes_[number] += push;
  return violation(rod, difference);
}

double Rods::violation(const Rod& rod, const Vector3& difference) {
  return std::abs(difference.norm() - rod.length) / rod.tolerance;
}

double Rods::residual(const Points& positions) const {
  double largest = 0.0;
  for (const Rod& rod : rods_) {
    if (rod.inverse_mass > 0.0) largest = std::max(largest, violation(rod, rod.ends.sum(positions) - rod.anchor));
  }
  return largest;
}

void Rods::add_pushes(const std::vector<Vector3>& pushes) {
  for (std::size_t r = 0; r < pushes.size(); ++r) pushes_[r] += pushes[r];
}

void Rods::add_impulses(double dt, std::vector<Link>& links) const {
  for (std::size_t r = 0; r < rods_.size(); ++r) links[rods_[r].number].impulse += pushes_[r] / dt;
}

}  // namespace sprung
