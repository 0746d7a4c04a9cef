// Functions shared by the builders of bodies. Internal to network/.
#pragma once

#include "network/bodies/body_shape.h"

#include <vector>

namespace sprung {

/// A body of these particles at rest, without masses, springs, surface and drag areas.
[[nodiscard]] BodyShape shape_of_particles(std::vector<Vector3> positions, const SpringMaterials& materials);

/// Adds half of the length of each segment to each of its ends.
void add_segment_measures(const Edges& segments, const std::vector<double>& lengths, std::vector<double>& measures);

/// k_s [N/m] of a spring that represents a `cross_section` (rope 1, cloth [m], solid [m^2]) of the body.
[[nodiscard]] double stiffness_of(const SpringMaterial& material, double cross_section, double rest_length);

/// k_d [N s/m] of a spring of this stiffness, without regard to `damping_ratio`.
[[nodiscard]] double damping_of(const SpringMaterial& material, double stiffness);

/// Adds a spring that represents a `cross_section` of the body.
void append_spring(Springs& springs, Index first, Index second, double rest_length, const SpringMaterial& material,
                   double cross_section, SpringKind kind);

/// Sets the surface and the exported faces of a body, and gives each particle a third of the area of its triangles as drag area.
void set_surface(BodyShape& shape, const Triangles& triangles);

/// A third of the area [m^2] of the triangles around each particle.
[[nodiscard]] std::vector<double> vertex_areas(const std::vector<Vector3>& positions, const Triangles& triangles);

}  // namespace sprung
