#include "dynamics/constraints/enclosed_volume.h"

#include "geometry/mesh/triangle_mesh.h"
#include "network/model/activity.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

constexpr double kTolerance = 1.0e-3;

// Of the change of volume that the present gradients give: less, and the body has turned too far in the step for those at its
// begin.
constexpr double kLeastAlong = 0.5;

}  // namespace

EnclosedVolume::EnclosedVolume(const SpringNetwork& network) : network_(network) {
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    const Body& body = network.bodies[b];
    if (body.volume_factor == 0.0 || is_asleep(network, body)) continue;
    const auto at_rest = network.positions.middleCols(body.first_particle, body.particle_count);
    kept_.push_back({b, body.volume_factor * signed_volume(at_rest, body.surface.triangles)});
  }
}

double EnclosedVolume::project(const Points& before, Points& positions, const ImpulseRecorder& recorder) const {
  double largest = 0.0;
  for (const Kept& kept : kept_) {
    const Body& body = network_.bodies[kept.body];
    const double missing = change(kept, positions);
    largest = std::max(largest, std::abs(missing / kept.volume));
    const auto inverse_masses = network_.inverse_masses.segment(body.first_particle, body.particle_count).transpose();
    const Points gradients = gradients_of(body, positions);
    const double sum = gradients.colwise().squaredNorm().dot(inverse_masses);
    if (!(sum > 0.0)) continue;
    Points directions = gradients_of(body, before);
    double along = directions.cwiseProduct(gradients).colwise().sum().dot(inverse_masses);
    if (!(along >= kLeastAlong * sum)) {
      directions = gradients;
      along = sum;
    }
    positions.middleCols(body.first_particle, body.particle_count) +=
        (missing / along) * (directions.array().rowwise() * inverse_masses.array()).matrix();
    for (Index i = 0; recorder.on() && i < body.particle_count; ++i) {
      const Index particle = body.first_particle + i;
      if (network_.is_fixed(particle)) recorder.add_to_pinned(particle, missing / along * directions.col(i));
    }
  }
  return largest / kTolerance;
}

/// Of the enclosed volume by the positions of the body's particles [m^2].
Points EnclosedVolume::gradients_of(const Body& body, const Points& positions) {
  Points gradients = Points::Zero(3, body.particle_count);
  add_volume_gradients(positions.middleCols(body.first_particle, body.particle_count), body.surface.triangles, 1.0, gradients);
  return gradients;
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
