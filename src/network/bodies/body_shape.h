// Ropes, cloths, solids and meshes as particles and springs, in their own frame.
#pragma once

#include "base/types.h"
#include "geometry/mesh/polygon_mesh.h"
#include "geometry/mesh/triangle_mesh.h"
#include "network/model/body.h"
#include "network/model/cells.h"
#include "network/model/face_bends.h"
#include "network/model/springs.h"

#include <array>
#include <limits>
#include <optional>
#include <vector>

namespace sprung {

/// Particles, springs and surface of one body; indices count from 0 within the body. The make_ functions return masses of 0;
/// `set_total_mass` or `set_density` sets them.
struct BodyShape {
  std::vector<Vector3> positions;   ///< [m]
  std::vector<Vector3> velocities;  ///< [m/s]
  std::vector<double> masses;       ///< [kg]
  std::vector<double> drag_areas;   ///< see SpringNetwork
  Springs springs;                  ///< in any order
  AngleBends angle_bends;
  Hinges hinges;
  FaceBends face_bends;
  Surface surface;
  int dimension = 0;     ///< of the measure: 1 length, 2 area, 3 volume; 0: none
  double measure = 0.0;  ///< length [m], area [m^2] or volume [m^3]
  /// Number of particles along x, which are numbered first, and along y of a cloth made by make_cloth. 0 for all other shapes.
  std::array<Index, 2> resolution{};
  /// Share of each particle in the measure: the region nearest to it, half or less of it on a border.
  std::vector<double> measures;
  /// Per kind of spring, in the order of SpringKind: the damping ratio from which NetworkBuilder computes k_d.
  std::array<std::optional<double>, 3> damping_ratios{};
  std::array<bool, 3> has_material_dampers{};  ///< see Body
  bool stretch_limited = true;                 ///< whether the stretch limit applies to its springs
  Cells cells;                                 ///< of solids
  std::vector<CellPoint> carried;              ///< see Body
  Index contact_only = 0;                      ///< see Body
  bool preserve_volume = false;                ///< see Body
  double volume_factor = 0.0;                  ///< see Body
  double pressure = 0.0;                       ///< see Body
  BodyDrag drag{};                             ///< see Body
};

/// Stiffness and damping of one kind of spring.
struct SpringMaterial {
  enum class Measure : std::uint8_t {
    stiffness,  ///< k_s [N/m] of each spring
    /// Rope EA [N], cloth and mesh [N/m], solid [Pa]: k_s = modulus * cross-section / rest length. The cross-section of a spring
    /// is its distance (solid: distances) to the parallel neighbours, half of it on a border. At any resolution, a body under a
    /// strain along its structural springs pulls with modulus * its whole cross-section * strain.
    modulus
  };
  double value = 0.0;  ///< >= 0
  Measure measure = Measure::stiffness;
  double damping = 0.0;  ///< k_d [N s/m], >= 0
  /// Alternative to `damping`, >= 0: k_d = 2 zeta k_s / omega, where omega is the frequency of the body's breathing motion about
  /// its pins (`breathing_frequency`). Breathing then decays with this ratio at any resolution; with 1 for all kinds of springs it
  /// is critically damped. A pair of particles of reduced mass m has k_d = 2 zeta sqrt(k_s m). Motion of a higher frequency omega'
  /// has the ratio zeta omega' / omega. Angle bends use `bending_frequency` instead.
  std::optional<double> damping_ratio{};
  /// Alternative to `damping` [s], >= 0: k_d = damping_time k. Motion of the frequency omega decays with the ratio damping_time
  /// omega / 2, at any resolution (Kelvin-Voigt).
  double damping_time = 0.0;
  bool tension_only = false;                               ///< see SpringLaw
  double yield = std::numeric_limits<double>::infinity();  ///< see SpringLaw
  double break_strain =
      std::numeric_limits<double>::infinity();  ///< of the length at rest at time 0, from which on a spring breaks
};

/// The springs of a body. A kind without a material has no springs.
struct SpringMaterials {
  /// How ropes and cloths resist bending. `spring`: springs that skip a particle. Their energy is of fourth order in the angle, so
  /// they do not resist a slight bend. `angle`: angle bends, which converge to the linear stiffness of beams and plates. For angle
  /// bends, `stiffness` is k [N m] of each one, `damping` its damping [N m s], and `modulus` is EI [N m^2] of a rope or D [N m] of
  /// a cloth: k = EI / l or k = D w / l, with bonds of length l at a distance w from their parallel neighbours (half of it on a
  /// border). Two pinned particles in a row clamp a body midway between them.
  enum class BendModel : std::uint8_t { spring, angle };

  std::optional<SpringMaterial> structural{};
  std::optional<SpringMaterial> shear{};
  std::optional<SpringMaterial> bend{};
  BendModel bend_model = BendModel::spring;
};

/// Largest number of particles of a body: 2^27, so that the numbers of its springs (up to 16 per particle) fit an Index.
inline constexpr Index kMaxBodyParticles = Index{1} << 27;

/// A polyline of at least 2 points [m]. It has `particles` >= 2 particles at equal distances, or one at each point by default.
/// Structural springs join neighbours, bend springs skip one particle. Rest lengths are measured along the polyline, so the rest
/// shape of a rope with corners is straight. `length` [m] > 0 is the rest length of the whole rope; by default, that of the
/// polyline.
struct RopeShape {
  std::vector<Vector3> points{};
  std::optional<Index> particles{};
  std::optional<double> length{};
};

/// A rectangle in the x-y plane, centred; x runs fastest. Structural springs lie along the sides of the cells, shear springs along
/// both diagonals, and bend springs along the sides, skipping one particle (Provot 1995). The triangles face +z. The diagonals
/// that cut the cells alternate like the squares of a chessboard.
struct ClothShape {
  std::array<double, 2> size{1.0, 1.0};   ///< [m], > 0
  std::array<Index, 2> resolution{2, 2};  ///< particles per side, >= 2
};

/// A box, centred; x runs fastest, then y, then z. Structural springs lie along the edges of the cells, shear springs along their
/// face and space diagonals, and bend springs along the edges, skipping one particle. The surface is the boundary.
struct SolidShape {
  Vector3 size = Vector3::Ones();            ///< [m], > 0
  std::array<Index, 3> resolution{2, 2, 2};  ///< particles per side, >= 2
};

/// Cubes that fill a closed surface and carry it. Springs lie in the cells as in those of a solid; each cell contributes to the
/// stiffness and the mass of its corners in proportion to its fraction.
struct LatticeShape {
  struct Cell {
    std::array<Index, 3> at;  ///< its numbers along x, y and z, from the origin
    double fraction = 1.0;    ///< of its volume that is within the surface, in (0, 1]
  };
  using Numbers = std::array<Index, 3>;
  /// The cell at a point [m].
  [[nodiscard]] Numbers cell_at(const Vector3& point) const;

  PolygonMesh surface;               ///< as exported
  TriangleMesh contact;              ///< its triangles, with long edges divided; each vertex lies in a cell
  Vector3 origin = Vector3::Zero();  ///< the lowest corner of cell (0, 0, 0) [m]
  double cell_size = 1.0;            ///< [m], > 0
  std::vector<Cell> cells;           ///< each once
};

/// The make_ functions throw InputError that names every broken rule of the shape (keys as in a scene: `size[0]`, `points[3]`) and
/// of the materials (`springs.bend.damping`).
[[nodiscard]] BodyShape make_rope(const RopeShape& rope, const SpringMaterials& materials);
[[nodiscard]] BodyShape make_cloth(const ClothShape& cloth, const SpringMaterials& materials);
[[nodiscard]] BodyShape make_solid(const SolidShape& solid, const SpringMaterials& materials);

/// Faces and lines of a mesh whose springs have other materials. A spring belongs to the part if these faces and lines alone have
/// it.
struct MeshPart {
  std::vector<Index> faces{};
  std::vector<Index> lines{};
  SpringMaterials materials{};  ///< of the kinds that differ; without damping_ratio
};

/// One particle per vertex, in the same order; faces, groups and UVs as given. Structural springs lie along edges and lines, and
/// shear springs along the diagonals of polygons that skip one corner. Bend springs cross the edges between two faces and join the
/// corners beyond them (of two triangles, the opposite corners). No two particles are joined twice: structural precedes shear,
/// shear precedes bend. Rest lengths are the distances in the mesh. A spring of several `parts` has the material of the last one.
[[nodiscard]] BodyShape make_mesh_body(const PolygonMesh& mesh, const SpringMaterials& materials,
                                       const std::vector<MeshPart>& parts = {});

/// The particles of the contact surface come first, in the order of its vertices, of which the first are those of `surface`, then
/// the corners of the cells. Half of the mass of each corner that carries vertices belongs to these vertices.
[[nodiscard]] BodyShape make_lattice_body(const LatticeShape& lattice, const SpringMaterials& materials);

/// Gives each particle the same share of `total` [kg]; of a carried surface and its cells, a share in proportion to its measure.
/// Throws InputError unless `total` is positive and finite.
void set_total_mass(BodyShape& shape, double total);

/// Gives each particle the mass of the region nearest to it: `density` [kg/m], [kg/m^2] or [kg/m^3] times its entry of `measures`.
/// Motion then does not depend on the resolution; particles on a border are lighter. Throws InputError unless `density` is
/// positive and finite and all measures are positive.
void set_density(BodyShape& shape, double density);

/// The drag of a body of this shape in air of 20 C. Lines have a `diameter` [m] >= 0. Across a face, a sheet has the drag
/// coefficient of a square plate, 1.17 (Hoerner 1965), and each face of a closed surface 0.5: a cube, of which the front and the
/// back feel the air, then has 1.0 (Hoerner: 1.05), a sphere 0.5 (0.47). Along a face, each side has the skin friction of a plate.
[[nodiscard]] BodyDrag drag_in_air(const BodyShape& shape, double diameter);

/// Rotates and moves a body, and adds a velocity [m/s]. Throws InputError if the pose is not a rotation and a translation: make the
/// shape in its final size.
void place(BodyShape& shape, const RigidTransform& pose, const Vector3& velocity = Vector3::Zero());

}  // namespace sprung
