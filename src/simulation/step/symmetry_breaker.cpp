#include "simulation/step/symmetry_breaker.h"

#include "base/random.h"
#include "base/sort_unique.h"
#include "geometry/mesh/union_find.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace sprung {
namespace {

// Distance from a line or plane that counts as rounding, relative to the extent.
constexpr double kFlatness = 1.0e-12;

// Sine of the angle between a line or plane and a normal that counts as lying in it.
constexpr double kInclination = 1.0e-6;

// Both, for pieces that are about to fall over.
constexpr double kNearly = 1.0e-3;

// Compression of a spring that is more than rounding.
constexpr double kCompression = 1.0e-9;

// Largest displacement in a step, relative to the mean rest length.
constexpr double kPush = 1.0e-9;

/// The particle for which `distance(particle)` is largest, the first of several.
template <class Distance>
Index farthest(const std::vector<Index>& particles, const Distance& distance) {
  Index found = particles.front();
  double largest = distance(found);
  for (const Index i : particles) {
    const double d = distance(i);
    if (d <= largest) continue;
    largest = d;
    found = i;
  }
  return found;
}

}  // namespace

SymmetryBreaker::SymmetryBreaker(const SpringNetwork& network, std::uint64_t seed)
    : network_(network), seed_(seed), piece_of_(static_cast<std::size_t>(network.particle_count()), kNone) {
  const Springs& springs = network.springs;
  UnionFind sets(network.particle_count());
  for (Index s = 0; s < springs.count(); ++s) sets.join(springs.first[s], springs.second[s]);
  for (Index s = 0; s < springs.count(); ++s) {
    Index& piece = piece_of_[sets.root(springs.first[s])];
    if (piece == kNone) {
      piece = static_cast<Index>(pieces_.size());
      pieces_.emplace_back();
    }
    pieces_[piece].springs.push_back(s);
    pieces_[piece].mean_length += springs.rest_length[s];
  }
  for (Index i = 0; i < network.particle_count(); ++i) {
    piece_of_[i] = piece_of_[sets.root(i)];
    if (piece_of_[i] != kNone) pieces_[piece_of_[i]].particles.push_back(i);
  }
  for (Piece& piece : pieces_) {
    piece.mean_length /= static_cast<double>(piece.springs.size());
    piece.corners.fill(piece.particles.front());
  }
}

bool SymmetryBreaker::may_push(const Points& positions) const {
  return std::ranges::any_of(pieces_,
                             [&](const Piece& piece) { return span_of(piece.corners, positions, kFlatness).dimension < 3; });
}

bool SymmetryBreaker::has_standing(const std::vector<ContactNormal>& contacts, const Points& positions) const {
  std::map<Index, std::pair<Flat, bool>> pieces;  // and whether all normals so far lie in it
  for (const auto& [particle, normal] : contacts) {
    const Index p = piece_of_[particle];
    if (p == kNone) continue;
    const auto [found, is_new] = pieces.try_emplace(p, Flat{}, true);
    auto& [flat, stands] = found->second;
    if (is_new) flat = span_of(spanning_corners(pieces_[p].particles, positions), positions, kNearly);
    stands = stands && flat.contains(normal, kNearly);
  }
  return std::ranges::any_of(pieces, [](const auto& piece) { return piece.second.second; });
}

void SymmetryBreaker::push(const std::vector<ContactNormal>& contacts, double dt, const Integrator& integrator,
                           SimulationState& state) {
  std::map<Index, Flat> flats;  // by piece
  for (const auto& [particle, normal] : contacts) {
    const Index p = piece_of_[particle];
    if (p == kNone) continue;
    const auto [found, is_new] = flats.try_emplace(p);
    Flat& flat = found->second;
    if (is_new) flat = measure(pieces_[p], state.x);
    if (!flat.contains(normal, kInclination)) continue;
    push(pieces_[p], flat, dt, integrator, state);
    flat = {};  // once is enough
  }
}

bool SymmetryBreaker::Flat::contains(const Vector3& unit, double inclination) const {
  if (dimension == 1) return direction.cross(unit).norm() <= inclination;
  return dimension == 2 && std::abs(direction.dot(unit)) <= inclination;
}

SymmetryBreaker::Flat SymmetryBreaker::span_of(const std::array<Index, 4>& corners, const Points& positions, double flatness) {
  const auto from_first = [&](std::size_t k) -> Vector3 { return positions.col(corners[k]) - positions.col(corners[0]); };
  const Vector3 along = from_first(1);
  const double extent = along.norm();
  if (extent == 0.0) return {.dimension = 0};
  const Vector3 normal = along.cross(from_first(2));
  if (normal.norm() <= flatness * extent * extent) return {.dimension = 1, .direction = along / extent};
  const Vector3 unit = normal.normalized();
  if (std::abs(unit.dot(from_first(3))) <= flatness * extent) return {.dimension = 2, .direction = unit};
  return {};
}

/// The particles that span the most.
std::array<Index, 4> SymmetryBreaker::spanning_corners(const std::vector<Index>& particles, const Points& positions) {
  std::array<Index, 4> corners{};
  corners.fill(particles.front());
  const auto from_first = [&](Index i) -> Vector3 { return positions.col(i) - positions.col(corners[0]); };
  corners[1] = farthest(particles, [&](Index i) { return from_first(i).squaredNorm(); });
  const Vector3 along = from_first(corners[1]);
  corners[2] = farthest(particles, [&](Index i) { return along.cross(from_first(i)).squaredNorm(); });
  const Vector3 normal = along.cross(from_first(corners[2]));
  corners[3] = farthest(particles, [&](Index i) { return std::abs(normal.dot(from_first(i))); });
  return corners;
}

/// Corners that span a volume need no search.
SymmetryBreaker::Flat SymmetryBreaker::measure(Piece& piece, const Points& positions) {
  if (const Flat flat = span_of(piece.corners, positions, kFlatness); flat.dimension == 3) return flat;
  piece.corners = spanning_corners(piece.particles, positions);
  return span_of(piece.corners, positions, kFlatness);
}

/// At most 1 long.
Vector3 SymmetryBreaker::direction_across(const Flat& flat, Index particle) const {
  const double turn = random_number(seed_, static_cast<std::uint64_t>(particle));
  if (flat.dimension == 2) return (2.0 * turn - 1.0) * flat.direction;
  const Vector3 side = flat.direction.unitOrthogonal();
  const double angle = 2.0 * std::numbers::pi * turn;
  return std::cos(angle) * side + std::sin(angle) * flat.direction.cross(side);
}

void SymmetryBreaker::push(const Piece& piece, const Flat& flat, double dt, const Integrator& integrator,
                           SimulationState& state) const {
  const Springs& springs = network_.springs;
  std::vector<Index> ends;
  for (const Index s : piece.springs) {
    const Index a = springs.first[s];
    const Index b = springs.second[s];
    if (springs.law(s).tension_only) continue;  // it is slack, not compressed
    if ((state.x.col(a) - state.x.col(b)).norm() >= (1.0 - kCompression) * springs.rest_length[s]) continue;
    ends.insert(ends.end(), {a, b});
  }
  sort_unique(ends);
  for (const Index i : ends) {
    if (network_.is_fixed(i)) continue;
    state.v.col(i) += kPush * piece.mean_length / dt * direction_across(flat, i);
    integrator.velocity_changed(state, i, dt);
  }
}

}  // namespace sprung
