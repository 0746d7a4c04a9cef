#include "network/body_shape.h"

#include "base/problem_list.h"
#include "network/shape_parts.h"

#include <utility>

namespace sprung {

BodyShape shape_of_particles(std::vector<Vector3> positions) {
  BodyShape shape;
  shape.positions = std::move(positions);
  shape.velocities.assign(shape.positions.size(), Vector3::Zero());
  shape.masses.assign(shape.positions.size(), 0.0);
  return shape;
}

double stiffness_of(const SpringMaterial& material, double cross_section, double rest_length) {
  if (material.measure == SpringMaterial::Measure::stiffness) return material.value;
  return material.value * cross_section / rest_length;
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
  shape.masses.assign(shape.positions.size(), total / static_cast<double>(shape.positions.size()));
}

void place(BodyShape& shape, const RigidTransform& pose, const Vector3& velocity) {
  for (Vector3& position : shape.positions) position = pose * position;
  for (Vector3& own : shape.velocities) own = pose.linear() * own + velocity;
}

}  // namespace sprung
