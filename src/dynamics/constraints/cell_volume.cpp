#include "dynamics/constraints/cell_volume.h"

#include "base/parallel.h"
#include "network/model/activity.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {
namespace {

constexpr double kTolerance = 0.01;  // of a region's volume
constexpr double kLeastFraction = 0.1;
constexpr double kInverted = 1.0;  // residual of an inverted part, as a relative change of volume

// A part below this multiple of its least volume may fall below it when the volume of its region changes.
constexpr double kWatched = 4.0;

constexpr Index kRegionsPerChunk = 128;
constexpr Index kGroupsPerChunk = 16;

// A region has at most as many particles as a byte can number; its gradients lie on the stack.
constexpr std::size_t kMaxParticles = 256;

/// The volume of a tetrahedron [m^3 / 6], and its derivatives by the positions of its corners.
struct PartVolume {
  double volume;
  std::array<Vector3, 4> gradients;

  PartVolume(const Vector3& origin, const Vector3& first, const Vector3& second, const Vector3& third) {
    const Vector3 a = first - origin;
    const Vector3 b = second - origin;
    const Vector3 c = third - origin;
    gradients[1] = b.cross(c);
    gradients[2] = c.cross(a);
    gradients[3] = a.cross(b);
    gradients[0] = -(gradients[1] + gradients[2] + gradients[3]);
    volume = a.dot(gradients[1]);
  }
};

PartVolume part_volume(std::span<const Index> particles, const std::array<std::uint8_t, 4>& corners, const Points& positions) {
  return {positions.col(particles[corners[0]]), positions.col(particles[corners[1]]), positions.col(particles[corners[2]]),
          positions.col(particles[corners[3]])};
}

template <class Number>
std::array<std::uint8_t, 4> bytes(const std::array<Number, 4>& numbers) {
  std::array<std::uint8_t, 4> result{};
  std::ranges::transform(numbers, result.begin(), [](Number number) { return static_cast<std::uint8_t>(number); });
  return result;
}

/// Moves particles along the gradients of a volume, in proportion to their inverse masses, so that it changes by `change` to first
/// order. Does nothing if no particle can move.
void change_volume(double change, std::span<const Index> particles, std::span<const Vector3> gradients,
                   const Scalars& inverse_masses, const ImpulseRecorder& recorder, Points& positions) {
  double sum = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i) sum += inverse_masses[particles[i]] * gradients[i].squaredNorm();
  if (!(sum > 0.0)) return;
  const double scale = change / sum;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    positions.col(particles[i]) += scale * inverse_masses[particles[i]] * gradients[i];
    if (recorder.on() && inverse_masses[particles[i]] == 0.0) recorder.add_to_pinned(particles[i], scale * gradients[i]);
  }
}

/// The largest relative change of volume in a group, none of whose parts may turn inside out.
double largest_change(const HexahedronGroup& group, const HexahedraVolumes& found) {
  double largest = std::ranges::min(found.least) <= 0.0 ? kInverted : 0.0;
  for (std::size_t lane = 0; lane < kHexahedraPerGroup; ++lane) {
    largest = std::max(largest, std::abs(found.total[lane] / group.volume[lane] - 1.0));
  }
  return largest;
}

}  // namespace

CellVolume::CellVolume(const SpringNetwork& network) : network_(network) {
  for (const Body& body : network.bodies) {
    if (body.preserve_volume && !is_asleep(network, body)) add_hexahedra(body);
  }
  const std::size_t hexahedra = volumes_.size();
  for (const Body& body : network.bodies) {
    if (body.preserve_volume && !is_asleep(network, body)) add_stars(body);
  }
  make_groups(colour_groups(volumes_.size(), network.particle_count(), [&](std::size_t r) { return region(r).particles; }),
              hexahedra);
}

/// The first regions are hexahedra.
void CellVolume::make_groups(const Colouring& colouring, std::size_t hexahedra) {
  for (std::size_t c = 0; c + 1 < colouring.colour_begin.size(); ++c) {
    std::vector<std::size_t> waiting;
    for (std::size_t k = colouring.colour_begin[c]; k < colouring.colour_begin[c + 1]; ++k) {
      const std::size_t number = colouring.order[k];
      const bool grouped = number < hexahedra && std::ranges::none_of(region(number).parts, [](const Part& part) {
                             return std::isfinite(part.least) && part.least <= 0.0;
                           });
      (grouped ? waiting : singles_).push_back(number);
      if (waiting.size() < kHexahedraPerGroup) continue;
      groups_.push_back(group_of(waiting));
      waiting.clear();
    }
    singles_.insert(singles_.end(), waiting.begin(), waiting.end());
    groups_begin_.push_back(groups_.size());
    singles_begin_.push_back(singles_.size());
  }
}

void CellVolume::add_hexahedra(const Body& body) {
  std::vector<Corners> parts;
  for (const auto& corners : kTetrahedraOfHexahedron) parts.push_back(bytes(corners));
  for (const Hexahedron& cell : body.cells.hexahedra) {
    std::vector<Index> particles(cell.begin(), cell.end());
    for (Index& particle : particles) particle += body.first_particle;
    add(particles, parts, kCornersOfHexahedron);
  }
}

void CellVolume::add_stars(const Body& body) {
  std::vector<std::vector<const Tetrahedron*>> stars(body.particle_count);
  for (const Tetrahedron& cell : body.cells.tetrahedra) {
    for (const Index corner : cell) stars[corner].push_back(&cell);
  }
  for (const auto& star : stars) {
    std::vector<Index> particles;
    std::vector<Corners> parts;
    for (const Tetrahedron* cell : star) {
      if (particles.size() + cell->size() > kMaxParticles) break;  // other stars have the rest
      std::array<std::ptrdiff_t, 4> corners{};
      for (std::size_t c = 0; c < corners.size(); ++c) {
        const auto known = std::ranges::find(particles, body.first_particle + (*cell)[c]);
        corners[c] = known - particles.begin();
        if (known == particles.end()) particles.push_back(body.first_particle + (*cell)[c]);
      }
      parts.push_back(bytes(corners));
    }
    if (!parts.empty()) add(particles, parts, parts.size());
  }
}

/// Computes the volumes at rest.
void CellVolume::add(const std::vector<Index>& particles, const std::vector<Corners>& parts, std::size_t upright) {
  double volume = 0.0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double of_part = part_volume(particles, parts[p], network_.positions).volume;
    const double least = p < upright ? kLeastFraction * of_part : -std::numeric_limits<double>::infinity();
    parts_.push_back({.corners = parts[p], .least = least});
    volume += of_part;
  }
  particles_.insert(particles_.end(), particles.begin(), particles.end());
  particles_begin_.push_back(particles_.size());
  parts_begin_.push_back(parts_.size());
  volumes_.push_back(volume);
}

HexahedronGroup CellVolume::group_of(const std::vector<std::size_t>& hexahedra) const {
  HexahedronGroup group;
  for (std::size_t lane = 0; lane < kHexahedraPerGroup; ++lane) {
    const Region of_lane = region(hexahedra[lane]);
    for (std::size_t c = 0; c < kCornersOfHexahedron; ++c) {
      group.particles[c][lane] = of_lane.particles[c];
      group.watched[c][lane] = kWatched * of_lane.parts[c].least;
    }
    group.volume[lane] = of_lane.volume;
    group.number[lane] = hexahedra[lane];
  }
  return group;
}

CellVolume::Region CellVolume::region(std::size_t number) const {
  return {
      .particles = std::span(particles_).subspan(particles_begin_[number], particles_begin_[number + 1] - particles_begin_[number]),
      .parts = std::span(parts_).subspan(parts_begin_[number], parts_begin_[number + 1] - parts_begin_[number]),
      .volume = volumes_[number]};
}

double CellVolume::project(const Points& /*before*/, Points& positions, const ImpulseRecorder& recorder) const {
  std::vector<double> changes(groups_.size() + singles_.size());
  for (std::size_t c = 0; c + 1 < groups_begin_.size(); ++c) {
    const std::size_t first_group = groups_begin_[c];
    parallel_chunks(static_cast<Index>(groups_begin_[c + 1] - first_group), kGroupsPerChunk, [&](Index begin, Index end) {
      project_groups(first_group + begin, first_group + end, positions, changes, recorder);
    });
    const std::size_t first = singles_begin_[c];
    parallel_chunks(static_cast<Index>(singles_begin_[c + 1] - first), kRegionsPerChunk, [&](Index begin, Index end) {
      for (std::size_t k = first + begin; k < first + end; ++k) {
        changes[groups_.size() + k] = project(region(singles_[k]), positions, recorder);
      }
    });
  }
  return changes.empty() ? 0.0 : std::ranges::max(changes) / kTolerance;
}

/// Writes the largest relative change of volume in each group. A chunk with pinned particles whose impulses are recorded is
/// projected cell by cell, which gives the same bits.
void CellVolume::project_groups(std::size_t begin, std::size_t end, Points& positions, std::vector<double>& changes,
                                const ImpulseRecorder& recorder) const {
  std::array<HexahedraFound, kGroupsPerChunk> found;
  const auto groups = std::span(groups_).subspan(begin, end - begin);
  if (recorder.on() && std::ranges::any_of(groups, [&](const HexahedronGroup& group) { return has_pinned(group); })) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      changes[begin + g] = 0.0;
      for (const std::size_t number : groups[g].number) {
        changes[begin + g] = std::max(changes[begin + g], project(region(number), positions, recorder));
      }
    }
    return;
  }
  project_hexahedra(groups, network_.inverse_masses.data(), positions.data(), found.data());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    changes[begin + g] = largest_change(groups[g], found[g].volumes);
    for (std::size_t lane = 0; lane < kHexahedraPerGroup; ++lane) {
      if (found[g].slack[lane] < 0.0) project_parts(region(groups[g].number[lane]), positions, recorder);
    }
  }
}

bool CellVolume::has_pinned(const HexahedronGroup& group) const {
  return std::ranges::any_of(group.particles, [&](const auto& corners) {
    return std::ranges::any_of(corners, [&](Index particle) { return network_.inverse_masses[particle] == 0.0; });
  });
}

double CellVolume::residual(const Points& positions) const {
  std::vector<double> changes(groups_.size() + singles_.size());
  parallel_chunks(static_cast<Index>(groups_.size()), kGroupsPerChunk, [&](Index begin, Index end) {
    std::array<HexahedraVolumes, kGroupsPerChunk> found;
    const auto groups = std::span(groups_).subspan(begin, end - begin);
    measure_hexahedra(groups, positions.data(), found.data());
    for (std::size_t g = 0; g < groups.size(); ++g) changes[begin + g] = largest_change(groups[g], found[g]);
  });
  parallel_chunks(static_cast<Index>(singles_.size()), kRegionsPerChunk, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) changes[groups_.size() + k] = change(region(singles_[k]), positions);
  });
  return changes.empty() ? 0.0 : std::ranges::max(changes) / kTolerance;
}

/// Returns the relative change of volume.
double CellVolume::change(const Region& region, const Points& positions) {
  double volume = 0.0;
  bool inverted = false;
  for (const Part& part : region.parts) {
    const double of_part = part_volume(region.particles, part.corners, positions).volume;
    inverted = inverted || is_inverted(part, of_part);
    volume += of_part;
  }
  return std::max(std::abs(volume / region.volume - 1.0), inverted ? kInverted : 0.0);
}

bool CellVolume::is_inverted(const Part& part, double volume) { return volume <= 0.0 && part.least > 0.0; }

/// Returns the relative change of volume before.
double CellVolume::project(const Region& region, Points& positions, const ImpulseRecorder& recorder) const {
  std::array<Vector3, kMaxParticles> gradients;
  std::fill_n(gradients.begin(), region.particles.size(), Vector3::Zero());
  double volume = 0.0;
  bool flat = false;
  bool inverted = false;
  for (const Part& part : region.parts) {
    const PartVolume of_part = part_volume(region.particles, part.corners, positions);
    for (std::size_t c = 0; c < part.corners.size(); ++c) gradients[part.corners[c]] += of_part.gradients[c];
    volume += of_part.volume;
    flat = flat || of_part.volume < kWatched * part.least;
    inverted = inverted || is_inverted(part, of_part.volume);
  }
  change_volume(region.volume - volume, region.particles, gradients, network_.inverse_masses, recorder, positions);
  if (flat) project_parts(region, positions, recorder);
  return std::max(std::abs(volume / region.volume - 1.0), inverted ? kInverted : 0.0);
}

void CellVolume::project_parts(const Region& region, Points& positions, const ImpulseRecorder& recorder) const {
  for (const Part& part : region.parts) {
    const PartVolume of_part = part_volume(region.particles, part.corners, positions);
    if (of_part.volume >= part.least) continue;
    const std::array<Index, 4> particles{region.particles[part.corners[0]], region.particles[part.corners[1]],
                                         region.particles[part.corners[2]], region.particles[part.corners[3]]};
    change_volume(part.least - of_part.volume, particles, of_part.gradients, network_.inverse_masses, recorder, positions);
  }
}

}  // namespace sprung
