#include "dynamics/constraints/enclosed_volume.h"

#include "geometry/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

constexpr double kTolerance = 1.0e-3;

/// The derivatives of the enclosed volume by the positions of the body's particles [m^2], 3 x n.
Points volume_gradients(const Triangles& triangles, const Eigen::Ref<const Points>& positions) {
  Points gradients = Points::Zero(3, positions.cols());
  for (const auto& triangle : triangles.colwise()) {
    for (int k = 0; k < 3; ++k) {
      const Vector3 next = positions.col(triangle[(k + 1) % 3]);
      const Vector3 last = positions.col(triangle[(k + 2) % 3]);
      gradients.col(triangle[k]) += next.cross(last) / 6.0;
    }
  }
  return gradients;
}

}  // namespace

EnclosedVolume::EnclosedVolume(const SpringNetwork& network) : network_(network) {
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    const Body& body = network.bodies[b];
    if (body.volume_factor == 0.0) continue;
    const Points at_rest = network.positions.middleCols(body.first_particle, body.particle_count);
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
    const Points gradients = volume_gradients(body.surface.triangles, particles);
    const double sum = gradients.colwise().squaredNorm().dot(inverse_masses);
    if (sum > 0.0) particles += (missing / sum) * (gradients.array().rowwise() * inverse_masses.array()).matrix();
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
