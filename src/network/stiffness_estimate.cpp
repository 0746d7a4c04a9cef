#include "network/stiffness_estimate.h"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <numbers>
#include <numeric>

namespace sprung {
namespace {

/// The direction in which the particles extend most.
Vector3 longest_direction(const Points& positions) {
  const Points centred = positions.colwise() - positions.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(centred * centred.transpose());
  return solver.eigenvectors().col(2);
}

/// sum k d^2 cos^4 of the angle between spring and direction; the springs of a rope follow it.
double stretch_resistance(const SpringNetwork& network, const Body& body, const Vector3& direction) {
  const Springs& springs = network.springs;
  double sum = 0.0;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    const Vector3 along = network.positions.col(springs.second[s]) - network.positions.col(springs.first[s]);
    const double length = along.norm();
    if (!(length > 0.0)) continue;
    const double cosine = body.dimension == 1 ? 1.0 : along.dot(direction) / length;
    sum += springs.stiffness[s] * springs.rest_length[s] * springs.rest_length[s] * std::pow(cosine, 4);
  }
  return sum;
}

}  // namespace

double bending_resistance(const SpringNetwork& network, const Body& body) {
  const AngleBends& bends = network.angle_bends;
  double resistance = 0.0;
  for (Index a = body.first_angle_bend; a < body.first_angle_bend + body.angle_bend_count; ++a) {
    const double length = (bends.length_before[a] + bends.length_after[a]) / 2.0;
    resistance += bends.stiffness[a] * length * length;
  }
  if (body.face_bend_count == 0) return resistance;
  const auto first = network.face_bends.stiffness.begin() + body.first_face_bend;
  const double mean = std::accumulate(first, first + body.face_bend_count, 0.0) / body.face_bend_count;
  return resistance + mean * body.dimension * body.measure;
}

StiffnessEstimate estimate_stiffness(const SpringNetwork& network, const Body& body, double gravity) {
  const Points positions = network.positions.middleCols(body.first_particle, body.particle_count);
  const Vector3 direction = longest_direction(positions);
  const Eigen::RowVectorXd along = direction.transpose() * positions;
  const double density = network.masses.segment(body.first_particle, body.particle_count).sum() / body.measure;
  const double modulus = stretch_resistance(network, body, direction) / body.measure;
  StiffnessEstimate estimate;
  estimate.length = body.dimension == 1 ? body.measure : along.maxCoeff() - along.minCoeff();
  estimate.sag = density * gravity * estimate.length * estimate.length / (2.0 * modulus);
  estimate.stretch_period = 4.0 * estimate.length * std::sqrt(density / modulus);
  estimate.swing_period = 2.0 * std::numbers::pi * std::sqrt(2.0 * estimate.length / (3.0 * gravity));
  const double rigidity = bending_resistance(network, body) / (body.dimension * body.measure);
  estimate.overhang = 2.0 * std::cbrt(rigidity / (density * gravity));
  return estimate;
}

}  // namespace sprung
