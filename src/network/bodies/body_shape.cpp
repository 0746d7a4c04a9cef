#include "network/bodies/body_shape.h"

#include "base/format.h"
#include "base/problem_list.h"
#include "geometry/mesh/topology.h"
#include "geometry/motion/motion_check.h"
#include "network/bodies/shape_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sprung {
namespace {

constexpr double kHalfDensity = 0.5 * kAirDensity;

/// Of a square plate across the wind (Hoerner, Fluid-Dynamic Drag, 1965, chapter 3).
constexpr double kPlate = 1.17;

/// Of each face of a closed surface. The front and the back of a cube feel u_n each: 2 * 0.5 = 1.0. On a sphere of radius R the
/// components along the wind are 0.5 |cos|^3 dA; their integral over the sphere is 0.5 * 4 pi R^2 / 4 = 0.5 pi R^2.
constexpr double kClosed = 0.5;

/// Of one side of a plate along the wind: 1.328 / sqrt(Re) (Blasius 1908) at Re = 7e4, that of 1 m at 1 m/s. Laminar and turbulent
/// plates of Re = 2e4 to 1e7 are between 0.003 and 0.01 (Hoerner 1965, chapter 2).
constexpr double kSkinFriction = 0.005;

}  // namespace

BodyShape shape_of_particles(std::vector<Vector3> positions, const SpringMaterials& materials) {
  BodyShape shape;
  shape.positions = std::move(positions);
  shape.velocities.assign(shape.positions.size(), Vector3::Zero());
  shape.masses.assign(shape.positions.size(), 0.0);
  const std::optional<SpringMaterial>* kinds[] = {&materials.structural, &materials.shear, &materials.bend};
  for (std::size_t kind = 0; kind < shape.damping_ratios.size(); ++kind) {
    if (*kinds[kind]) shape.damping_ratios[kind] = (*kinds[kind])->damping_ratio;
  }
  return shape;
}

void add_segment_measures(const Edges& segments, const std::vector<double>& lengths, std::vector<double>& measures) {
  for (Eigen::Index s = 0; s < segments.cols(); ++s) {
    for (const Index end : segments.col(s)) measures[end] += lengths[s] / 2.0;
  }
}

double stiffness_of(const SpringMaterial& material, double cross_section, double rest_length) {
  if (material.measure == SpringMaterial::Measure::stiffness) return material.value;
  return material.value * cross_section / rest_length;
}

double damping_of(const SpringMaterial& material, double stiffness) { return material.damping + material.damping_time * stiffness; }

void append_spring(Springs& springs, Index first, Index second, double rest_length, const SpringMaterial& material,
                   double cross_section, SpringKind kind) {
  const double stiffness = stiffness_of(material, cross_section, rest_length);
  const bool breaks = rest_length > 0.0 && std::isfinite(material.break_strain);
  springs.append(first, second, rest_length, stiffness, damping_of(material, stiffness), kind,
                 {.tension_only = material.tension_only,
                  .yield = material.yield,
                  .break_length = breaks ? rest_length * (1.0 + material.break_strain) : SpringLaw().break_length});
}

void set_surface(BodyShape& shape, const Triangles& triangles) {
  shape.surface.faces = to_polygons(triangles);
  shape.surface.triangles = triangles;
  shape.drag_areas = vertex_areas(shape.positions, triangles);
}

std::vector<double> vertex_areas(const std::vector<Vector3>& positions, const Triangles& triangles) {
  std::vector<double> areas(positions.size(), 0.0);
  for (const auto& corners : triangles.colwise()) {
    const Vector3& a = positions[corners[0]];
    const double third = (positions[corners[1]] - a).cross(positions[corners[2]] - a).norm() / 6.0;
    for (const Index corner : corners) areas[corner] += third;
  }
  return areas;
}

void set_total_mass(BodyShape& shape, double total) {
  ProblemList problems;
  problems.require_positive("mass", total, "give the mass of the whole body in kg");
  problems.throw_if_any();
  if (shape.carried.empty()) {
    shape.masses.assign(shape.positions.size(), total / static_cast<double>(shape.positions.size()));
  } else {
    shape.masses = shape.measures;
    for (double& mass : shape.masses) mass *= total / shape.measure;
  }
}

void set_density(BodyShape& shape, double density) {
  ProblemList problems;
  problems.require_positive("density", density, "give the mass of a metre, a square metre or a cubic metre in kg");
  const auto bare = std::find(shape.measures.begin(), shape.measures.end(), 0.0);
  if (bare != shape.measures.end()) {
    problems.add("density", format_number(density),
                 "gives no mass to particle " + std::to_string(bare - shape.measures.begin()) +
                     ", which is in no face (in a mesh without faces: in no line)",
                 "give mass or particle_mass, or remove such vertices from the mesh");
  }
  problems.throw_if_any();
  for (std::size_t i = 0; i < shape.masses.size(); ++i) shape.masses[i] = density * shape.measures[i];
}

BodyDrag drag_in_air(const BodyShape& shape, double diameter) {
  const Surface& surface = shape.surface;
  if (surface.triangles.cols() == 0) return {.line_diameter = diameter};
  if (!shape.cells.empty() || is_closed(surface.triangles)) {
    return {.normal = kHalfDensity * kClosed, .tangential = kHalfDensity * kSkinFriction};
  }
  return {.normal = kHalfDensity * kPlate, .tangential = kHalfDensity * 2.0 * kSkinFriction};
}

void place(BodyShape& shape, const RigidTransform& pose, const Vector3& velocity) {
  ProblemList problems;
  check_pose("place", pose, problems);
  problems.throw_if_any();
  for (Vector3& position : shape.positions) position = pose * position;
  for (Vector3& own : shape.velocities) own = pose.linear() * own + velocity;
}

}  // namespace sprung
