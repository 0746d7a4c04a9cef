// Ropes, cloths, solids and meshes as particles and springs, in their own frame.
#pragma once

#include "network/spring_network.h"

#include <array>
#include <optional>
#include <vector>

namespace sprung {

/// Particles, springs and surface of one body; indices count from 0 within the body. What the make_ functions return has
/// masses of 0: `set_total_mass` or `set_density` gives them.
struct BodyShape {
  std::vector<Vector3> positions;   ///< [m]
  std::vector<Vector3> velocities;  ///< [m/s]
  std::vector<double> masses;       ///< [kg]
  std::vector<double> drag_areas;   ///< see SpringNetwork
  Springs springs;                  ///< in any order
  AngleBends angle_bends;
  Surface surface;
  int dimension = 0;     ///< of what `measure` measures: 1 length, 2 area, 3 volume; 0: nothing
  double measure = 0.0;  ///< length [m], area [m^2] or volume [m^3]
  /// Of a cloth that make_cloth made: particles along x, which are numbered first, and along y; 0 of all else.
  std::array<Index, 2> resolution{};
  std::vector<double> measures;  ///< each particle's part of it: what is nearest to it, on a border half of it or less
  /// Of each kind of spring, in the order of SpringKind: the damping ratio that NetworkBuilder turns into k_d.
  std::array<std::optional<double>, 3> damping_ratios{};
};

/// Spring constants of one kind of spring.
struct SpringMaterial {
  enum class Measure : std::uint8_t {
    stiffness,  ///< k_s [N/m] of each spring
    /// Rope EA [N], cloth and mesh [N/m], solid [Pa]: k_s = modulus * cross-section / rest length, where a spring's cross-section
    /// is the distance (solid: distances) to its parallel neighbours, on a border half of it. Stretched by a strain along its
    /// structural springs, a body pulls back with modulus * whole cross-section * strain at any resolution.
    modulus
  };
  double value = 0.0;  ///< >= 0
  Measure measure = Measure::stiffness;
  double damping = 0.0;  ///< k_d [N s/m], >= 0
  /// Instead of `damping`, >= 0: k_d = 2 zeta k_s / omega, omega being the body's breathing about its pins: see
  /// `breathing_frequency`. Breathing then dies out with this ratio (1: without swinging, when every kind has it), whatever the
  /// resolution; a pair of particles has k_d = 2 zeta sqrt(k_s m) with its reduced mass m. Faster motion of frequency omega' is
  /// damped by zeta omega' / omega. Of angle bends: the same with `bending_frequency`.
  std::optional<double> damping_ratio{};
};

/// Which springs to make: a kind without a material is left out.
struct SpringMaterials {
  /// How ropes and cloths resist bending: by springs that skip a particle, whose resistance to a slight bend is nothing (their
  /// energy grows with the fourth power of the angle), or by angle bends, which converge to a beam's and a plate's linear
  /// resistance. With angle bends `stiffness` is k [N m] of each, `damping` [N m s], and `modulus` EI [N m^2] of a rope, D [N m] of
  /// a cloth: k = EI / l, D w / l with bonds of length l, w apart from their parallel neighbours (half of it on a border). A body
  /// is clamped by pinning two particles in a row, half-way between them.
  enum class BendModel : std::uint8_t { spring, angle };

  std::optional<SpringMaterial> structural{};
  std::optional<SpringMaterial> shear{};
  std::optional<SpringMaterial> bend{};
  BendModel bend_model = BendModel::spring;
};

/// Most particles of a body: 2^27, so that the numbers of its springs (up to 16 a particle) fit an Index.
inline constexpr Index kMaxBodyParticles = Index{1} << 27;

/// A polyline of at least 2 points [m]: `particles` >= 2 at equal distances along it, or one at each point when not given.
/// Structural springs join neighbours, bend springs skip one; rest lengths are measured along the polyline, so a rope laid around
/// a corner wants to be straight. `length` [m] > 0 is the rest length of the whole when it is not the polyline's own.
struct RopeShape {
  std::vector<Vector3> points;
  std::optional<Index> particles;
  std::optional<double> length;
};

/// A rectangle in the x-y plane, centred; particles x fastest. Structural springs along the sides of the cells, shear along both
/// diagonals, bend along the sides and skipping one particle (Provot 1995). Its triangles face +z, and the diagonals that cut the
/// cells alternate like the squares of a chessboard.
struct ClothShape {
  std::array<double, 2> size{1.0, 1.0};   ///< [m], > 0
  std::array<Index, 2> resolution{2, 2};  ///< particles per side, >= 2
};

/// A box, centred; particles x fastest, then y, then z. Structural springs along the edges of the cells, shear along their face and
/// space diagonals, bend along the edges and skipping one particle. Its surface is the boundary.
struct SolidShape {
  Vector3 size = Vector3::Ones();            ///< [m], > 0
  std::array<Index, 3> resolution{2, 2, 2};  ///< particles per side, >= 2
};

/// The make_ functions throw InputError with every broken rule of the shape (keys as in a scene: `size[0]`, `points[3]`) and of
/// the materials (`springs.bend.damping`).
[[nodiscard]] BodyShape make_rope(const RopeShape& rope, const SpringMaterials& materials);
[[nodiscard]] BodyShape make_cloth(const ClothShape& cloth, const SpringMaterials& materials);
[[nodiscard]] BodyShape make_solid(const SolidShape& solid, const SpringMaterials& materials);

/// A particle per vertex, in its order; faces, groups and UVs as given. Structural springs along edges and lines, shear along the
/// diagonals of polygons that skip one corner, bend across the edges that two faces share, joining what lies in line beyond them
/// (of two triangles the opposite corners). No two particles are joined twice: structural comes before shear, shear before bend.
/// Rest lengths are the distances in the mesh.
[[nodiscard]] BodyShape make_mesh_body(const PolygonMesh& mesh, const SpringMaterials& materials);

/// Gives each particle the same share of `total` [kg]. Throws InputError unless it is positive and finite.
void set_total_mass(BodyShape& shape, double total);

/// Gives each particle the mass of what is nearest to it, `density` [kg/m], [kg/m^2] or [kg/m^3] times its entry of `measures`, so
/// that motion does not depend on resolution: particles on a border are lighter. Throws InputError unless it is positive and
/// finite, and when there are particles without a length, an area or a volume.
void set_density(BodyShape& shape, double density);

/// Rotates, then moves a body, and adds a velocity [m/s]. There is no scale here: give the make_ functions sizes, points and
/// vertices as large as the body shall be.
void place(BodyShape& shape, const RigidTransform& pose, const Vector3& velocity = Vector3::Zero());

}  // namespace sprung
