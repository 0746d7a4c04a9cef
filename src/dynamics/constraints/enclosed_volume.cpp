#include "dynamics/constraints/enclosed_volume.h"

#include "geometry/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

constexpr double kTolerance = 1.0e-3;

}  // namespace

EnclosedVolume::EnclosedVolume(const SpringNetwork& network) : network_(network) {
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    const Body& body = network.bodies[b];
    if (body.volume_factor == 0.0 || body.asleep) continue;
    const auto at_rest = network.positions.middleCols(body.first_particle, body.particle_count);
    kept_.push_back({b, body.volume_factor * signed_volume(at_rest, body.surface.triangles)});
  }
}

double EnclosedVolume::project(const Points& /*before*/, Points& positions) const {
  double largest = 0.0;
  for (const Kept& kept : kept_) {
    const Body& body = network_.bodies[kept.body];
    auto particles = positions.middleCols(body.first_particle, body.particle_count);
    const auto inverse_masses = network_.inverse_masses.segment(body.first_particle, body.particle_count).transpose();
    const double missing = change(kept, positions);
    Points gradients = Points::Zero(3, body.particle_count);
    add_volume_gradients(particles, body.surface.triangles, 1.0, gradients);
    const double sum = gradients.colwise().squaredNorm().dot(inverse_masses);
    if (sum > 0.0) particles += (missing / sum) * (gradients.array().rowwise() * inverse_masses.array()).matrix();
    for (Index i = 0; sum > 0.0 && recorder().on() && i < body.particle_count; ++i) {
      const Index particle = body.first_particle + i;
      if (network_.is_pinned(particle)) recorder().add_to_pinned(particle, missing / sum * gradients.col(i));
    }
    largest = std::max(largest, std::abs(missing / kept.volume));
  }
  return largest / kTolerance;
}

double EnclosedVolume::residual(const Points& positions) const {
  double largest = 0.0;
  for (const Kept& kept : kept_) largest = std::max(largest, std::abs(change(kept, positions) / kept.volume));
  return largest / kTolerance;
}

/// What is missing of the kept volume [m^3].
double EnclosedVolume::change(const Kept& kept, const Points& positions) const {
  const Body& body = network_.bodies[kept.body];
  return kept.volume - signed_volume(positions.middleCols(body.first_particle, body.particle_count), body.surface.triangles);
}

}  // namespace sprung
