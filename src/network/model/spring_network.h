// The network: masses, springs, bodies and pins. Most of what a step changes is in `simulation_state.h`.
#pragma once

#include "base/contact_material.h"
#include "base/types.h"
#include "geometry/mesh/polygon_mesh.h"
#include "geometry/motion/motion.h"
#include "network/model/attachment.h"
#include "network/model/cells.h"
#include "network/model/face_bends.h"

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace sprung {

enum class SpringKind : std::uint8_t { structural, shear, bend };
inline constexpr std::array<const char*, 3> kSpringKindNames{"structural", "shear", "bend"};  ///< in the order of the kinds

/// What a spring does besides to pull and push in proportion to its strain, (length - rest length) / rest length. By default
/// nothing.
struct SpringLaw {
  bool tension_only = false;  ///< a spring that is not longer than at rest has no force, neither elastic nor of its damper
  /// Perfect plasticity: after each step, a spring with a larger strain, stretched or compressed, gets the rest length at which
  /// the strain is this one. > 0
  double yield = std::numeric_limits<double>::infinity();
  double break_length = std::numeric_limits<double>::infinity();  ///< longer springs break [m], > 0

  [[nodiscard]] bool yields() const { return yield < std::numeric_limits<double>::infinity(); }
  [[nodiscard]] bool breaks() const { return break_length < std::numeric_limits<double>::infinity(); }
  [[nodiscard]] bool operator==(const SpringLaw&) const = default;
};

/// Springs as arrays; entry s of each array belongs to spring s. Within a body they are sorted by (second - first, first), so that
/// neighbours in a lattice make contiguous runs.
struct Springs {
  std::vector<Index> first;         ///< particle at one end, the lower index
  std::vector<Index> second;        ///< particle at the other end
  std::vector<double> rest_length;  ///< d [m], >= 0
  std::vector<double> stiffness;    ///< k_s [N/m], >= 0
  std::vector<double> damping;      ///< k_d [N s/m], >= 0
  std::vector<SpringKind> kind;
  std::vector<SpringLaw> laws{};  ///< empty if all are the default

  [[nodiscard]] Index count() const { return static_cast<Index>(first.size()); }
  [[nodiscard]] SpringLaw law(Index spring) const { return laws.empty() ? SpringLaw() : laws[spring]; }
  /// Adds a spring; sorts its two ends.
  void append(Index a, Index b, double rest, double k_s, double k_d, SpringKind spring_kind, const SpringLaw& law = {});
};

/// Elements that keep three particles in line, as arrays; entry a of each array belongs to element a. The bond middle - after
/// deviates from the direction of the bond before - middle by an angle theta, from 0 (in line) to pi (folded back). The energy is
/// 1/2 k theta^2 [J].
struct AngleBends {
  std::vector<Index> before;
  std::vector<Index> middle;
  std::vector<Index> after;
  std::vector<double> length_before;  ///< rest lengths of the bonds [m], > 0
  std::vector<double> length_after;
  std::vector<double> stiffness;  ///< k [N m/rad], >= 0
  std::vector<double> damping;    ///< of the rate of theta [N m s], >= 0

  [[nodiscard]] Index count() const { return static_cast<Index>(middle.size()); }
  /// Particles and bond lengths in the order before, middle, after.
  void append(const std::array<Index, 3>& particles, const std::array<double, 2>& lengths, double k, double k_d);
};

/// The surface of a body, for collision and export. Vertex i is particle i of the body; particles that follow are inside.
struct Surface {
  PolygonFaces faces;         ///< as exported, with those that are torn
  Triangles triangles;        ///< for contact: of the triangulated faces without those that are torn; see Body::contact_only
  Edges segments;             ///< of ropes: the edges without a triangle; and threads that hold after their faces tore
  std::vector<Index> torn{};  ///< faces that are gone because a spring broke, ascending
};

/// The bodies with which a body collides.
struct BodyContact {
  bool self = false;   ///< with its own elements, as in a cloth that folds onto itself
  bool others = true;  ///< with other bodies for which this is set too
};

/// A named range of particles, springs, angle bends and face bends.
struct Body {
  std::string name;
  Index first_particle = 0;
  Index particle_count = 0;
  Index first_spring = 0;
  Index spring_count = 0;
  Index first_angle_bend = 0;
  Index angle_bend_count = 0;
  Index first_face_bend = 0;
  Index face_bend_count = 0;
  int dimension = 0;                  ///< of its measure, see BodyShape
  double measure = 0.0;               ///< length [m], area [m^2] or volume [m^3]; 0 for particles added one by one
  std::array<Index, 2> resolution{};  ///< of a cloth, see BodyShape
  Surface surface;
  ContactMaterial material;
  BodyContact contact;
  bool stretch_limited = true;  ///< whether the stretch limit applies to its springs
  Cells cells;                  ///< of solids; in the numbering of the body
  /// Where the first particles of the body lie in its cells: passes keep them there. Empty unless cells carry a surface.
  std::vector<CellPoint> carried;
  /// How many of these, the last ones, contact alone has: they divide edges longer than a cell, which `faces` keep whole.
  Index contact_only = 0;
  bool preserve_volume = false;  ///< whether passes keep the volume of the cells
  double volume_factor = 0.0;    ///< of a closed surface: the multiple of its volume at rest that passes keep; 0: none
  double pressure = 0.0;         ///< in a closed surface, along the normals of its triangles [Pa]
  /// Per kind of spring, in the order of SpringKind; angle bends and face bends count as `bend`. Whether the dampers are those of a
  /// material: no explicit scheme but explicit Euler needs smaller steps because of them.
  std::array<bool, 3> has_material_dampers{};

  /// The number of particles, the first ones, that are vertices of the surface for contact.
  [[nodiscard]] Index contact_vertex_count() const { return carried.empty() ? particle_count : static_cast<Index>(carried.size()); }
  /// The number of particles, the first ones, that are vertices of exported frames.
  [[nodiscard]] Index exported_vertex_count() const { return contact_vertex_count() - contact_only; }
};

/// Particles that follow a prescribed motion or an obstacle. With the default motion they rest. A pin that begins after time 0
/// takes its particles at their positions at that time. Then it moves them by the change of its pose since. A simulator rounds both
/// times to steps.
struct Pin {
  std::vector<Index> particles;      ///< of the network
  Vector3 origin = Vector3::Zero();  ///< origin of the rotation [m]
  Motion motion;
  Index obstacle = kNone;  ///< of the simulator, which the particles follow instead of `motion`; kNone: none
  double from = 0.0;       ///< when it takes its particles [s], >= 0
  double until = std::numeric_limits<double>::infinity();  ///< when it lets go of them [s], > from
  std::string name{};  ///< under which its force is reported; NetworkBuilder gives `pins[k]` to its pin k if it has none

  [[nodiscard]] bool moves() const { return obstacle != kNone || motion.moves(); }
  [[nodiscard]] bool holds_always() const { return from == 0.0 && until == std::numeric_limits<double>::infinity(); }
};

/// The model of a network, from NetworkBuilder. A step of a simulator changes in its own one the rest lengths of springs that
/// yield, springs that break with what goes with them, and pins that begin or end.
struct SpringNetwork {
  Points positions;        ///< at time 0 [m], 3 x n
  Points velocities;       ///< at time 0 [m/s], 3 x n; 0 of pinned particles
  Scalars masses;          ///< [kg], > 0
  Scalars inverse_masses;  ///< [1/kg]; 0 for pinned particles and those that sleep
  Scalars drag_areas;      ///< factor of the air drag: the particle's share in the area [m^2] of its body's faces, plus that
                           ///< in the length [m] of its segments; 1 in a body without either
  Springs springs;
  AngleBends angle_bends;
  Hinges hinges;
  FaceBends face_bends;
  std::vector<Body> bodies;
  std::vector<Pin> pins;                 ///< that hold their particles
  std::vector<Pin> later_pins;           ///< that have not begun
  std::vector<std::string> pin_names{};  ///< of all pins, in the order in which they were added, also of those that have ended
  std::vector<Attachment> attachments{};
  Springs broken{};            ///< that broke and are gone, with those that went with them
  std::vector<char> asleep{};  ///< by particle, see set_asleep(); empty: none sleeps

  [[nodiscard]] Index particle_count() const { return static_cast<Index>(masses.size()); }
  /// Whether the particle is pinned or sleeps.
  [[nodiscard]] bool is_pinned(Index particle) const { return inverse_masses[particle] == 0.0; }
  [[nodiscard]] bool is_asleep(Index particle) const { return !asleep.empty() && asleep[particle] != 0; }
  /// The body of a particle. Requires a particle of the network.
  [[nodiscard]] const Body& body_of(Index particle) const;
};

/// The columns of the particles that are vertices of surfaces for contact, without the cells that carry some of them, 3 x m.
[[nodiscard]] Points contact_positions(const SpringNetwork& network, const Points& positions);

/// Whether a body may collide with itself or with another body.
[[nodiscard]] bool bodies_may_collide(const SpringNetwork& network);

}  // namespace sprung
