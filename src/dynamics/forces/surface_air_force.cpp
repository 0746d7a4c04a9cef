#include "dynamics/forces/surface_air_force.h"

#include "base/parallel.h"
#include "dynamics/forces/force_derivatives.h"
#include "dynamics/numerics/block_matrix.h"
#include "geometry/mesh/triangle_mesh.h"
#include "network/model/spring_network.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace sprung {
namespace {

constexpr Index kChunk = 1024;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// C_t of a line: wires and cables along the wind (Hoerner 1965, chapter 3).
constexpr double kAlongLine = 0.02;

/// By size: of a face [kg/(m^2 s)], of a line [kg/(m s)].
struct Resistance {
  double secant = 0.0;   ///< force / speed
  double tangent = 0.0;  ///< d force / d speed
};

/// Of the force c u (u + low_speed) while its derivative is below `limit`, then linear. The two branches are one formula for
/// low_speed = 0. The second one keeps the roundings of scenes with `air.surface`.
Resistance quadratic(double coefficient, double speed, double limit, double low_speed = 0.0) {
  const double rate = coefficient * (2.0 * speed + low_speed);
  if (low_speed > 0.0) {
    const double from = std::max(0.0, 0.5 * (limit / coefficient - low_speed));
    if (speed <= from) return {coefficient * (speed + low_speed), rate};
    return {limit - coefficient * from * from / speed, limit};
  }
  if (rate <= limit) return {coefficient * speed, rate};
  return {limit * (1.0 - 0.5 * limit / rate), limit};
}

Resistance resistance(bool is_quadratic, double coefficient, double speed, double limit, double low_speed) {
  return is_quadratic ? quadratic(coefficient, speed, limit, low_speed) : Resistance{coefficient, coefficient};
}

/// Of a cylinder across the air, with the force k (u^2 + b u^(4/3)), k = rho d / 2 and b = 10 (nu / d)^(2/3), while its derivative
/// is below `limit`, then linear.
Resistance cylinder(double diameter, double speed, double limit) {
  const double k = 0.5 * kAirDensity * diameter;
  const double b = 10.0 * std::pow(kAirViscosity / diameter, 2.0 / 3.0);
  const double root = std::cbrt(speed);
  const double rate = k * (2.0 * speed + 4.0 / 3.0 * b * root);
  if (rate <= limit) return {speed == 0.0 ? 0.0 : k * (speed + b * root), rate};
  // The derivative is `limit` at y^3: y^3 + 3 p y = 2 r with p = 2 b / 9 and r = limit / (4 k).
  const double p = 2.0 / 9.0 * b;
  const double y = 2.0 * std::sqrt(p) * std::sinh(std::asinh(0.25 * limit / (k * p * std::sqrt(p))) / 3.0);
  const double from = y * y * y;
  const double force = k * y * from * (y * y + b) + limit * (speed - from);
  return {force / speed, limit};
}

/// The ends of an element.
std::span<const Index> ends_of(const AirElement& element) {
  return std::span(element.ends).first(static_cast<std::size_t>(element.count));
}

double area_of(const Points& positions, const Eigen::Array3i& corners) {
  return 0.5 * area_normal(positions.col(corners[0]), positions.col(corners[1]), positions.col(corners[2])).norm();
}

/// Of the body at rest [m^2], with the faces that are torn. The step was chosen for the whole body, and its expected speed has to
/// stay.
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

/// The air on a face or line: F = size (axial u_a + radial u_r). u_a is the part of u along the axis and u_r the rest. The axis is
/// the normal of a face or the direction of a line.
struct SurfaceAirForce::Flow {
  double size = 0.0;                 ///< area [m^2] or length [m]
  Vector3 axis = Vector3::Zero();    ///< of length 1; 0 without size
  Vector3 along = Vector3::Zero();   ///< u_a [m/s]
  Vector3 across = Vector3::Zero();  ///< u_r [m/s]
  Resistance axial{};
  Resistance radial{};

  [[nodiscard]] Vector3 force() const { return size * (axial.secant * along + radial.secant * across); }

  /// dF/du [N s/m], symmetric without negative eigenvalues.
  [[nodiscard]] Matrix3 derivative() const {
    const Matrix3 projection = axis * axis.transpose();
    Matrix3 result = axial.tangent * projection + radial.secant * (Matrix3::Identity() - projection);
    const double squared_speed = across.squaredNorm();
    if (squared_speed > 0.0) result += (radial.tangent - radial.secant) / squared_speed * (across * across.transpose());
    return size * result;
  }
};

/// The velocity of the air at all particles.
struct SurfaceAirForce::Air {
  Vector3 mean;       ///< [m/s]
  Points velocities;  ///< [m/s], 3 x n; empty if it is the mean everywhere
};

/// The damping rate of an element. A particle of mass m gives the mass m s / S to an element of rest size s, where S is the sum of
/// the rest sizes of its elements. An element of n ends with the damping D = dF/du slows an end at the rate D / n by this mass. The
/// largest of these is the rate of the element. The rows of -M^-1 dF/dv sum up to means of the rates, weighted by s / S, so that no
/// motion is damped faster than the rate of the fastest element.
SurfaceAirForce::SurfaceAirForce(const SpringNetwork& network, const SurfaceDrag& drag, Wind wind, double gravity, double step)
    : network_(network), wind_(std::move(wind)), step_(step) {
  Scalars sizes = Scalars::Zero(network.particle_count());
  for (const Body& body : network.bodies) add_body(body, drag, gravity, sizes);
  find_shares(sizes);
  expect_wind();
  list_elements_of_particles();
}

void SurfaceAirForce::add_body(const Body& body, const SurfaceDrag& drag, double gravity, Scalars& sizes) {
  const std::size_t law = laws_.size();
  if (body.drag.line_diameter > 0.0 && body.surface.faces.face_count() == 0) {
    laws_.push_back({.diameter = body.drag.line_diameter});
    for (const auto& segment : body.surface.segments.colwise()) {
      const Eigen::Array2i ends = segment.array() + body.first_particle;
      const double length = (network_.positions.col(ends[1]) - network_.positions.col(ends[0])).norm();
      add_element({.ends = {ends[0], ends[1], kNone}, .count = 2, .law = law, .rest_size = length}, sizes);
    }
    return;
  }
  const bool own = body.drag.normal > 0.0 || body.drag.tangential > 0.0;
  if (!own && drag.is_zero()) return;
  Law& faces = laws_.emplace_back();
  faces.faces = own ? SurfaceDrag{.normal = body.drag.normal, .tangential = body.drag.tangential, .quadratic = true} : drag;
  faces.low_speed = own ? kLowSpeed : 0.0;
  if (!own) {
    const double mass = network_.masses.segment(body.first_particle, body.particle_count).sum();
    faces.fall = std::sqrt(gravity * mass / (total_area(network_, body) * std::max(drag.normal, drag.tangential)));
  }
  for (const auto& triangle : body.surface.triangles.colwise()) {
    const Eigen::Array3i corners = triangle.array() + body.first_particle;
    add_element(
        {.ends = {corners[0], corners[1], corners[2]}, .count = 3, .law = law, .rest_size = area_of(network_.positions, corners)},
        sizes);
  }
}

void SurfaceAirForce::add_element(const AirElement& element, Scalars& sizes) {
  if (element.rest_size == 0.0) return;
  const std::span<const Index> ends = ends_of(element);
  for (const Index i : ends) sizes[i] += element.rest_size;
  if (std::ranges::all_of(ends, [&](Index i) { return network_.is_asleep(i); })) return;
  elements_.push_back(element);
}

void SurfaceAirForce::find_shares(const Scalars& sizes) {
  for (AirElement& element : elements_) {
    for (const Index i : ends_of(element)) {
      element.rate_share =
          std::max(element.rate_share, sizes[i] * network_.inverse_masses[i] / (element.count * element.rest_size));
    }
    Law& law = laws_[element.law];
    law.end = static_cast<Index>(&element - elements_.data()) + 1;
    law.share = std::max(law.share, element.rest_size * element.rate_share);
  }
}

void SurfaceAirForce::expect_wind() {
  for (Law& law : laws_) {
    const double coefficient = std::max(law.faces.normal, law.faces.tangential);
    const double speed = wind_.usual_speed() + law.fall;
    if (law.diameter > 0.0) {
      law.expected = cylinder(law.diameter, speed, kNoLimit).tangent;
    } else {
      law.expected = law.faces.quadratic ? 2.0 * coefficient * speed : coefficient;
    }
  }
}

void SurfaceAirForce::follow(const Conditions& conditions) {
  wind_ = conditions.wind;
  expect_wind();
}

void SurfaceAirForce::list_elements_of_particles() {
  first_entry_.assign(static_cast<std::size_t>(network_.particle_count()) + 1, 0);
  for (const AirElement& element : elements_) {
    for (const Index i : ends_of(element)) ++first_entry_[i + 1];
  }
  for (std::size_t i = 1; i < first_entry_.size(); ++i) first_entry_[i] += first_entry_[i - 1];
  elements_at_.resize(static_cast<std::size_t>(first_entry_.back()));
  std::vector<Index> next = first_entry_;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    for (const Index i : ends_of(elements_[e])) elements_at_[next[i]++] = static_cast<Index>(e);
  }
}

SurfaceAirForce::Air SurfaceAirForce::air_at(const Kinematics& at) const {
  return {.mean = wind_.mean(at.time), .velocities = wind_.gusts() ? wind_.velocities(at.x, at.time) : Points(3, 0)};
}

SurfaceAirForce::Flow SurfaceAirForce::flow(const AirElement& element, const Kinematics& at, const Air& air) const {
  const std::array<Index, 3>& ends = element.ends;
  const auto mean = [&](const Points& of) -> Vector3 {
    if (element.count == 2) return 0.5 * (of.col(ends[0]) + of.col(ends[1]));
    return (of.col(ends[0]) + of.col(ends[1]) + of.col(ends[2])) / 3.0;
  };
  Flow flow;
  const bool is_face = element.count == 3;
  const Vector3 axis = is_face ? area_normal(at.x.col(ends[0]), at.x.col(ends[1]), at.x.col(ends[2]))
                               : Vector3(at.x.col(ends[1]) - at.x.col(ends[0]));
  const double length = axis.norm();
  if (length == 0.0) return flow;
  flow.size = is_face ? 0.5 * length : length;
  flow.axis = axis / length;
  const Vector3 relative = (air.velocities.cols() == 0 ? air.mean : mean(air.velocities)) - mean(at.v);
  flow.along = flow.axis.dot(relative) * flow.axis;
  flow.across = relative - flow.along;
  const Law& law = laws_[element.law];
  const double of_step = kRateOfStep / (step_ * flow.size * element.rate_share);  // infinite for implicit schemes
  const double limit = std::max(law.expected, of_step);
  if (is_face) {
    flow.axial = resistance(law.faces.quadratic, law.faces.normal, flow.along.norm(), limit, law.low_speed);
    flow.radial = resistance(law.faces.quadratic, law.faces.tangential, flow.across.norm(), limit, 0.0);
  } else {
    flow.axial = quadratic(0.5 * kAirDensity * law.diameter * kAlongLine, flow.along.norm(), limit);
    flow.radial = cylinder(law.diameter, flow.across.norm(), limit);
  }
  return flow;
}

/// The force [N] on each end of the elements from `begin` to `end`.
void SurfaceAirForce::find_end_forces(const Kinematics& at, const Air& air, Index begin, Index end, Points& end_forces) const {
  while (begin < end) {
    const Law& law = laws_[elements_[begin].law];
    const Index next = std::min(end, law.end);
    if (law.diameter > 0.0) {
      for (Index e = begin; e < next; ++e) end_forces.col(e) = 0.5 * flow(elements_[e], at, air).force();
    } else {
      const FaceAir of_body{.positions = at.x.data(),
                            .velocities = at.v.data(),
                            .air = air.velocities.cols() == 0 ? nullptr : air.velocities.data(),
                            .mean = air.mean,
                            .normal = law.faces.normal,
                            .tangential = law.faces.tangential,
                            .quadratic = law.faces.quadratic,
                            .low_speed = law.low_speed,
                            .expected = law.expected,
                            .step = step_};
      find_face_forces(&elements_[begin], next - begin, of_body, end_forces.col(begin).data());
    }
    begin = next;
  }
}

void SurfaceAirForce::add(const Kinematics& at, Points& forces) const {
  const Air air = air_at(at);
  const auto count = static_cast<Index>(elements_.size());
  Points end_forces(3, count);
  parallel_chunks(count, kChunk, [&](Index begin, Index end) { find_end_forces(at, air, begin, end, end_forces); });
  parallel_chunks(network_.particle_count(), kChunk, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      for (Index entry = first_entry_[i]; entry < first_entry_[i + 1]; ++entry)
        forces.col(i) += end_forces.col(elements_at_[entry]);
    }
  });
}

void SurfaceAirForce::couple(std::vector<ParticlePair>& pairs) const {
  for (const AirElement& element : elements_) {
    for (int k = 0; k < element.count; ++k) {
      for (int m = 0; m < k; ++m) pairs.push_back({element.ends[k], element.ends[m]});
    }
  }
}

void SurfaceAirForce::add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const {
  const Air air = air_at(at);
  for (const AirElement& element : elements_) {
    const Matrix3 block = flow(element, at, air).derivative() / -(element.count * element.count);
    for (int k = 0; k < element.count; ++k) {
      for (int m = 0; m <= k; ++m) derivatives.by_velocity.add(element.ends[k], element.ends[m], block);
    }
  }
}

void SurfaceAirForce::append_elements(std::vector<LinearElement>& elements) const {
  for (const AirElement& element : elements_) {
    const double damping = laws_[element.law].expected * element.rest_size;
    if (damping == 0.0) continue;
    const double weight = 1.0 / element.count;
    elements.push_back({.particles = {element.ends[0], element.ends[1], element.ends[2]},
                        .weights = {weight, weight, weight},
                        .count = static_cast<std::size_t>(element.count),
                        .damping = damping});
  }
}

double SurfaceAirForce::largest_acceleration() const {
  const double speed = wind_.max_speed();
  double acceleration = 0.0;
  for (const Law& law : laws_) {
    const double coefficient = std::max(law.faces.normal, law.faces.tangential);
    double by_size = coefficient * (law.faces.quadratic ? speed * (speed + law.low_speed) : speed);
    if (law.diameter > 0.0) by_size = speed * cylinder(law.diameter, speed, kNoLimit).secant;
    acceleration = std::max(acceleration, by_size * law.share);
  }
  return acceleration;
}

}  // namespace sprung
