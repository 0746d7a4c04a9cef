// What the builders of bodies share. Internal to network/.
#pragma once

#include "network/body_shape.h"

#include <vector>

namespace sprung {

/// A body of these particles at rest, without mass, springs, surface and drag areas.
[[nodiscard]] BodyShape shape_of_particles(std::vector<Vector3> positions, const SpringMaterials& materials);

/// Half of each segment's length at each of its ends.
void add_segment_measures(const Edges& segments, const std::vector<double>& lengths, std::vector<double>& measures);

/// k_s [N/m] of a spring that stands for a `cross_section` (rope 1, cloth [m], solid [m^2]) of the body.
[[nodiscard]] double stiffness_of(const SpringMaterial& material, double cross_section, double rest_length);

/// Makes the triangles a body's surface and exported faces, and gives each particle a third of the area of the triangles
/// around it as its drag area.
void set_surface(BodyShape& shape, const Triangles& triangles);

/// A third of the area [m^2] of the triangles around each particle.
[[nodiscard]] std::vector<double> vertex_areas(const std::vector<Vector3>& positions, const Triangles& triangles);

}  // namespace sprung
