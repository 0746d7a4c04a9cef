// Ropes, cloths, solids and meshes as particles and springs, in their own frame.
#pragma once

#include "network/spring_network.h"

#include <array>
#include <optional>
#include <vector>

namespace sprung {

/// Particles, springs and surface of one body; indices count from 0 within the body.
struct BodyShape {
  std::vector<Vector3> positions;   ///< [m]
  std::vector<Vector3> velocities;  ///< [m/s]
  std::vector<double> masses;       ///< [kg]
  std::vector<double> drag_areas;   ///< see SpringNetwork
  Springs springs;                  ///< in any order
  Surface surface;
  double measure = 0.0;  ///< length [m], area [m^2] or volume [m^3]: what a density multiplies
};

/// Spring constants of one kind of spring.
struct SpringMaterial {
  enum class Measure : std::uint8_t {
    stiffness,  ///< k_s [N/m] of each spring
    modulus     ///< rope EA [N], cloth [N/m], solid [Pa]: k_s = modulus * (share of the cross-section) / rest length
  };
  double value = 0.0;  ///< >= 0
  Measure measure = Measure::stiffness;
  double damping = 0.0;  ///< k_d [N s/m], >= 0
};

/// Which springs to make: a kind without a material is left out.
struct SpringMaterials {
  std::optional<SpringMaterial> structural;
  std::optional<SpringMaterial> shear;
  std::optional<SpringMaterial> bend;
};

/// A polyline of at least 2 points [m]: `particles` >= 2 at equal distances along it, or one at each point when not given.
/// Structural springs join neighbours, bend springs skip one. `length` [m] is the rest length of the whole when it is not the
/// polyline's own.
struct RopeShape {
  std::vector<Vector3> points;
  std::optional<Index> particles;
  std::optional<double> length;
};
[[nodiscard]] BodyShape make_rope(const RopeShape& rope, const SpringMaterials& materials);

/// A rectangle in the x-y plane, centred; particles x fastest. Structural springs along the sides of the cells, shear along both
/// diagonals, bend along the sides and skipping one particle (Provot 1995).
struct ClothShape {
  std::array<double, 2> size{1.0, 1.0};   ///< [m], > 0
  std::array<Index, 2> resolution{2, 2};  ///< particles per side, >= 2
};
[[nodiscard]] BodyShape make_cloth(const ClothShape& cloth, const SpringMaterials& materials);

/// A box, centred; particles x fastest, then y, then z. Structural springs along the edges of the cells, shear along their face and
/// space diagonals, bend along the edges and skipping one particle. Its surface is the boundary.
struct SolidShape {
  Vector3 size = Vector3::Ones();            ///< [m], > 0
  std::array<Index, 3> resolution{2, 2, 2};  ///< particles per side, >= 2
};
[[nodiscard]] BodyShape make_solid(const SolidShape& solid, const SpringMaterials& materials);

/// A particle per vertex, in its order. Structural springs along edges, shear along the diagonals of polygons, bend across the
/// edges that two faces share. Rest lengths are the distances in the mesh.
[[nodiscard]] BodyShape make_mesh_body(const PolygonMesh& mesh, const SpringMaterials& materials);

/// Gives each particle the same share of `total` [kg].
void set_total_mass(BodyShape& shape, double total);

/// Scales (lengths, rest lengths, areas), then rotates, then moves a body, and adds a velocity [m/s].
void place(BodyShape& shape, double scale, const RigidTransform& pose, const Vector3& velocity);

}  // namespace sprung
