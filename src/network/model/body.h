// A body: a named range of a network, with its surface and cells.
#pragma once

#include "base/contact_material.h"
#include "base/types.h"
#include "geometry/mesh/polygon_mesh.h"
#include "network/model/body_drag.h"
#include "network/model/cells.h"

#include <array>
#include <string>
#include <vector>

namespace sprung {

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
  /// body with a material: no explicit scheme but explicit Euler needs smaller steps because of them.
  std::array<bool, 3> has_material_dampers{};
  BodyDrag drag;  ///< of its own; none: that of the settings

  /// The number of particles, the first ones, that are vertices of the surface for contact.
  [[nodiscard]] Index contact_vertex_count() const { return carried.empty() ? particle_count : static_cast<Index>(carried.size()); }
  /// The number of particles, the first ones, that are vertices of exported frames.
  [[nodiscard]] Index exported_vertex_count() const { return contact_vertex_count() - contact_only; }
};

}  // namespace sprung
