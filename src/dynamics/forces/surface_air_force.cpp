#include "dynamics/forces/surface_air_force.h"

#include "base/parallel.h"
#include "dynamics/forces/force_derivatives.h"
#include "dynamics/numerics/block_matrix.h"
#include "geometry/mesh/triangle_mesh.h"
#include "network/model/spring_network.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sprung {
namespace {

constexpr Index kChunk = 1024;

/// Leapfrog schemes then stay stable in steps up to 0.93 of the largest stable one: with a damping rate of 1 / (4 dt) they need
/// dt^2 l_K + 1 / 2 < 4.
constexpr double kRateOfStep = 0.25;

/// Force by speed, and its derivative, by area [kg/(m^2 s)].
struct Resistance {
  double secant = 0.0;
  double tangent = 0.0;
};

/// Quadratic while the derivative is below `limit`, then linear.
Resistance quadratic(double coefficient, double speed, double limit) {
  const double rate = 2.0 * coefficient * speed;
  if (rate <= limit) return {coefficient * speed, rate};
  return {limit * (1.0 - 0.5 * limit / rate), limit};
}

Resistance resistance(bool is_quadratic, double coefficient, double speed, double limit) {
  return is_quadratic ? quadratic(coefficient, speed, limit) : Resistance{coefficient, coefficient};
}

double area_of(const Points& positions, const Eigen::Array3i& corners) {
  return 0.5 * area_normal(positions.col(corners[0]), positions.col(corners[1]), positions.col(corners[2])).norm();
}

/// At rest, with the faces that are torn: what is expected of a whole body bounds the step of a torn one too.
double total_area(const SpringNetwork& network, const Body& body) {
  const Surface& surface = body.surface;
  const Triangles triangles = surface.torn.empty() ? surface.triangles : triangulate(surface.faces);
  double area = 0.0;
  for (const auto& triangle : triangles.colwise()) {
    area += area_of(network.positions, triangle.array() + body.first_particle);
  }
  return area;
}

}  // namespace

/// The air on a face: F = A (across u_n + along u_t).
struct SurfaceAirForce::Flow {
  double area = 0.0;                 ///< [m^2]
  Vector3 normal = Vector3::Zero();  ///< of length 1; 0 without area
  Vector3 across = Vector3::Zero();  ///< u_n [m/s]
  Vector3 along = Vector3::Zero();   ///< u_t [m/s]
  Resistance normal_resistance{};
  Resistance tangential_resistance{};

  [[nodiscard]] Vector3 force() const { return area * (normal_resistance.secant * across + tangential_resistance.secant * along); }

  /// dF/du [N s/m], symmetric without negative eigenvalues.
  [[nodiscard]] Matrix3 derivative() const {
    const Matrix3 out = normal * normal.transpose();
    Matrix3 result = normal_resistance.tangent * out + tangential_resistance.secant * (Matrix3::Identity() - out);
    const double squared_speed = along.squaredNorm();
    if (squared_speed > 0.0) {
      result += (tangential_resistance.tangent - tangential_resistance.secant) / squared_speed * (along * along.transpose());
    }
    return area * result;
  }
};

/// The velocity of the air at all particles.
struct SurfaceAirForce::Air {
  Vector3 mean;       ///< [m/s]
  Points velocities;  ///< [m/s], 3 x n; empty if it is the mean everywhere

  [[nodiscard]] Vector3 at(const Eigen::Array3i& corners) const {
    if (velocities.cols() == 0) return mean;
    return (velocities.col(corners[0]) + velocities.col(corners[1]) + velocities.col(corners[2])) / 3.0;
  }
};

/// A particle of mass m has the share m A / S in a face, with the sum S of the rest areas A of its faces. Damping D = dF/du slows a
/// corner at the rate D / 3 divided by this share; the largest of its corners is the rate of the face. No motion is slowed at a
/// higher rate than the highest of the faces: the rows of -M^-1 dF/dv sum up to means of their rates, weighted by the shares.
SurfaceAirForce::SurfaceAirForce(const SpringNetwork& network, const SurfaceDrag& drag, Wind wind, double gravity, double step)
    : network_(network), drag_(drag), wind_(std::move(wind)), step_(step) {
  const double coefficient = std::max(drag.normal, drag.tangential);
  Scalars areas = Scalars::Zero(network.particle_count());
  for (const Body& body : network.bodies) {
    const double mass = network.masses.segment(body.first_particle, body.particle_count).sum();
    const double fall = std::sqrt(gravity * mass / (total_area(network, body) * coefficient));
    const double expected = drag.quadratic ? 2.0 * coefficient * (wind_.usual_speed() + fall) : coefficient;
    for (const auto& triangle : body.surface.triangles.colwise()) {
      const Eigen::Array3i corners = triangle.array() + body.first_particle;
      const double area = area_of(network.positions, corners);
      if (area == 0.0) continue;
      for (const Index i : corners) areas[i] += area;
      if (std::ranges::all_of(corners, [&](Index i) { return network.is_asleep(i); })) continue;
      faces_.push_back({.corners = corners, .rest_area = area, .expected = expected});
    }
  }
  for (Face& face : faces_) {
    for (const Index i : face.corners) {
      face.rate_share = std::max(face.rate_share, areas[i] * network.inverse_masses[i] / (3.0 * face.rest_area));
    }
  }
  list_faces_of_particles();
}

void SurfaceAirForce::list_faces_of_particles() {
  first_entry_.assign(static_cast<std::size_t>(network_.particle_count()) + 1, 0);
  for (const Face& face : faces_) {
    for (const Index i : face.corners) ++first_entry_[i + 1];
  }
  for (std::size_t i = 1; i < first_entry_.size(); ++i) first_entry_[i] += first_entry_[i - 1];
  faces_at_.resize(3 * faces_.size());
  std::vector<Index> next = first_entry_;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    for (const Index i : faces_[f].corners) faces_at_[next[i]++] = static_cast<Index>(f);
  }
}

SurfaceAirForce::Air SurfaceAirForce::air_at(const Kinematics& at) const {
  return {.mean = wind_.mean(at.time), .velocities = wind_.gusts() ? wind_.velocities(at.x, at.time) : Points(3, 0)};
}

SurfaceAirForce::Flow SurfaceAirForce::flow(const Face& face, const Kinematics& at, const Air& air) const {
  const Eigen::Array3i& corners = face.corners;
  Flow flow;
  const Vector3 twice_area = area_normal(at.x.col(corners[0]), at.x.col(corners[1]), at.x.col(corners[2]));
  const double length = twice_area.norm();
  if (length == 0.0) return flow;
  flow.area = 0.5 * length;
  flow.normal = twice_area / length;
  const Vector3 relative = air.at(corners) - (at.v.col(corners[0]) + at.v.col(corners[1]) + at.v.col(corners[2])) / 3.0;
  flow.across = flow.normal.dot(relative) * flow.normal;
  flow.along = relative - flow.across;
  const double of_step = kRateOfStep / (step_ * flow.area * face.rate_share);  // infinite for implicit schemes
  const double limit = std::max(face.expected, of_step);
  flow.normal_resistance = resistance(drag_.quadratic, drag_.normal, flow.across.norm(), limit);
  flow.tangential_resistance = resistance(drag_.quadratic, drag_.tangential, flow.along.norm(), limit);
  return flow;
}

void SurfaceAirForce::add(const Kinematics& at, Points& forces) const {
  const Air air = air_at(at);
  const auto face_count = static_cast<Index>(faces_.size());
  Points thirds(3, face_count);
  parallel_chunks(face_count, kChunk, [&](Index begin, Index end) {
    for (Index f = begin; f < end; ++f) thirds.col(f) = flow(faces_[f], at, air).force() / 3.0;
  });
  parallel_chunks(network_.particle_count(), kChunk, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      for (Index entry = first_entry_[i]; entry < first_entry_[i + 1]; ++entry) forces.col(i) += thirds.col(faces_at_[entry]);
    }
  });
}

void SurfaceAirForce::couple(std::vector<ParticlePair>& pairs) const {
  for (const Face& face : faces_) {
    for (int k = 0; k < 3; ++k) pairs.push_back({face.corners[k], face.corners[(k + 1) % 3]});
  }
}

void SurfaceAirForce::add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const {
  const Air air = air_at(at);
  for (const Face& face : faces_) {
    const Matrix3 block = flow(face, at, air).derivative() / -9.0;
    for (int k = 0; k < 3; ++k) {
      derivatives.by_velocity.add(face.corners[k], face.corners[k], block);
      derivatives.by_velocity.add(face.corners[k], face.corners[(k + 1) % 3], block);
    }
  }
}

void SurfaceAirForce::append_elements(std::vector<LinearElement>& elements) const {
  constexpr double kThird = 1.0 / 3.0;
  for (const Face& face : faces_) {
    elements.push_back({.particles = {face.corners[0], face.corners[1], face.corners[2]},
                        .weights = {kThird, kThird, kThird},
                        .count = 3,
                        .damping = face.expected * face.rest_area});
  }
}

double SurfaceAirForce::largest_acceleration() const {
  const double speed = wind_.max_speed();
  const double pressure = std::max(drag_.normal, drag_.tangential) * (drag_.quadratic ? speed * speed : speed);
  double acceleration = 0.0;
  for (const Face& face : faces_) acceleration = std::max(acceleration, pressure * face.rest_area * face.rate_share);
  return acceleration;
}

}  // namespace sprung
