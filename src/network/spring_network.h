// The network: masses, springs, bodies and pins. Constant once built; what a step changes is in `simulation_state.h`.
#pragma once

#include "base/contact_material.h"
#include "base/types.h"
#include "geometry/mesh/polygon_mesh.h"
#include "geometry/motion/motion.h"

#include <array>
#include <string>
#include <vector>

namespace sprung {

enum class SpringKind : std::uint8_t { structural, shear, bend };
inline constexpr std::array<const char*, 3> kSpringKindNames{"structural", "shear", "bend"};  ///< in the order of the kinds

/// Springs as arrays; entry s of each belongs to spring s. Within a body they are sorted by (second - first, first), so that
/// neighbours in a lattice make contiguous runs.
struct Springs {
  std::vector<Index> first;         ///< particle at one end, the lower index
  std::vector<Index> second;        ///< particle at the other end
  std::vector<double> rest_length;  ///< d [m], >= 0
  std::vector<double> stiffness;    ///< k_s [N/m], >= 0
  std::vector<double> damping;      ///< k_d [N s/m], >= 0
  std::vector<SpringKind> kind;

  [[nodiscard]] Index count() const { return static_cast<Index>(first.size()); }
  /// Adds a spring, whichever end has the lower index.
  void append(Index a, Index b, double rest, double k_s, double k_d, SpringKind spring_kind);
};

/// Elements that keep three particles in line, as arrays; entry a of each belongs to element a. The bonds before - middle and
/// middle - after turn by theta at the middle, from 0 (in line) to pi (folded back), which costs 1/2 k theta^2 [J].
struct AngleBends {
  std::vector<Index> before;
  std::vector<Index> middle;
  std::vector<Index> after;
  std::vector<double> length_before;  ///< of the bonds at rest [m], > 0
  std::vector<double> length_after;
  std::vector<double> stiffness;  ///< k [N m], a radian, >= 0
  std::vector<double> damping;    ///< [N m s], of the rate of theta, >= 0

  [[nodiscard]] Index count() const { return static_cast<Index>(middle.size()); }
  /// Particles and bonds in the order before, middle, after.
  void append(const std::array<Index, 3>& particles, const std::array<double, 2>& lengths, double k, double k_d);
};

/// What of a body collides and is exported. Vertex i is the body's particle i.
struct Surface {
  PolygonFaces faces;   ///< as exported
  Triangles triangles;  ///< the faces, fanned
  Edges segments;       ///< of ropes: the edges that no triangle has
};

/// What of the network a body collides with.
struct BodyContact {
  bool self = false;   ///< its own elements, as in a cloth that folds onto itself
  bool others = true;  ///< other bodies that have this set too
};

/// A named range of particles, springs and angle bends.
struct Body {
  std::string name;
  Index first_particle = 0;
  Index particle_count = 0;
  Index first_spring = 0;
  Index spring_count = 0;
  Index first_angle_bend = 0;
  Index angle_bend_count = 0;
  int dimension = 0;                  ///< of its measure, see BodyShape
  double measure = 0.0;               ///< length [m], area [m^2] or volume [m^3]; 0 for particles added one by one
  std::array<Index, 2> resolution{};  ///< of a cloth, see BodyShape
  Surface surface;
  ContactMaterial material;
  BodyContact contact;
};

/// Particles held where their motion takes them. With the default motion they stay where they began.
struct Pin {
  std::vector<Index> particles;      ///< of the network
  Vector3 origin = Vector3::Zero();  ///< what the motion turns about [m]
  Motion motion;
};

/// The const model of a network. Made by NetworkBuilder.
struct SpringNetwork {
  Points positions;        ///< at time 0 [m], 3 x n
  Points velocities;       ///< at time 0 [m/s], 3 x n; 0 of pinned particles
  Scalars masses;          ///< [kg], > 0
  Scalars inverse_masses;  ///< [1/kg]; 0 for pinned particles
  Scalars drag_areas;      ///< what air drag multiplies: a third of the area [m^2] of the surface triangles around a
                           ///< particle, 0 within a solid; 1 for particles of ropes and those without a surface
  Springs springs;
  AngleBends angle_bends;
  std::vector<Body> bodies;
  std::vector<Pin> pins;

  [[nodiscard]] Index particle_count() const { return static_cast<Index>(masses.size()); }
  [[nodiscard]] bool is_pinned(Index particle) const { return inverse_masses[particle] == 0.0; }
  /// The body that holds a particle. Requires a particle of the network.
  [[nodiscard]] const Body& body_of(Index particle) const;
};

/// Whether contact is asked for within a body, or between two.
[[nodiscard]] bool bodies_may_collide(const SpringNetwork& network);

}  // namespace sprung
