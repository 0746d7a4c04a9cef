// A scene file as plain data: the user's values, with defaults filled in.
#pragma once

#include "base/contact_material.h"
#include "base/types.h"
#include "collision/shapes/obstacle.h"
#include "geometry/motion/motion.h"
#include "network/bodies/body_shape.h"
#include "network/model/body.h"
#include "network/model/springs.h"
#include "simulation/settings/simulator_settings.h"

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace sprung {

/// Scale, then rotation [degrees] about the fixed axes x, y, z, then position [m].
struct Placement {
  Vector3 position = Vector3::Zero();
  Vector3 rotation = Vector3::Zero();
  double scale = 1.0;
};

/// A mesh file, as named in the scene.
struct MeshFile {
  std::string file;
  std::optional<double> weld{};  ///< of a body: vertices at most this far apart are one particle [m]
};

/// The OBJ files of a deforming mesh, one per frame.
struct MeshFiles {
  std::variant<std::vector<std::string>, std::string> files;  ///< in order, or a pattern with one *
  double frame_rate = 30.0;                                   ///< [1/s]
  double start = 0.0;                                         ///< time of the first [s]
  bool loop = false;
};

/// A closed mesh that cells fill.
struct LatticeFile {
  std::string file;
  Index cells = 0;         ///< along the longest side; 0: `cell_size` says it
  double cell_size = 0.0;  ///< after scaling [m]
};

/// A file of tetrahedra, or one of the two that TetGen writes.
struct TetrahedraFile {
  std::string file;
};

using BodyShapeScene = std::variant<RopeShape, ClothShape, SolidShape, MeshFile, LatticeFile, TetrahedraFile>;
using ObstacleShapeScene = std::variant<MeshFile, MeshFiles, SphereGeometry, BoxGeometry, CapsuleGeometry, CylinderGeometry,
                                        ConeGeometry, EllipsoidGeometry, HalfSpaceGeometry>;

struct CornersSelector {
  std::vector<std::string> which;
};  ///< `min_min`, ... of a cloth, `min_min_min`, ... of a solid, `from`, `to` of a rope
struct IndicesSelector {
  std::vector<Index> indices;
};  ///< of particles of the body
struct NearestSelector {
  Vector3 point;
};  ///< the particle nearest to a point in the world [m]
struct BoxSelector {
  Vector3 lower;
  Vector3 upper;
};  ///< particles in a box in the world [m]
struct SphereSelector {
  Vector3 centre;
  double radius;
};  ///< particles in a sphere in the world [m]
struct GroupSelector {
  std::string name;
};  ///< vertices of the faces and lines of a group, object or material of a mesh

/// Particles of a body, by their positions at time 0.
using Selector = std::variant<CornersSelector, IndicesSelector, NearestSelector, BoxSelector, SphereSelector, GroupSelector>;

struct PinScene {
  std::string name{};  ///< empty: none
  Selector where;
  Motion motion{};
  std::string follow{};  ///< name of the obstacle that the particles follow instead of `motion`; empty: none
  double from = 0.0;     ///< [s]
  double until = std::numeric_limits<double>::infinity();  ///< [s]
};

/// A mass [kg] that each of the particles has in addition.
struct PointMassScene {
  Selector where;
  double mass = 0.0;
};

/// The material of the springs of one kind in a group, object or material of a mesh.
struct SpringGroupScene {
  SpringKind kind = SpringKind::structural;
  std::string name;
  SpringMaterial material;
};

/// Exactly one of mass [kg] of the body, of each particle, or per length, area or volume.
struct MassScene {
  enum class Kind : std::uint8_t { body, particle, density } kind = Kind::body;
  double value = 0.0;
};

struct BodyScene {
  std::string name;
  BodyShapeScene shape;
  std::string preset;                  ///< name of its material; empty: none
  bool preset_limits_stretch = false;  ///< whether a stretch limit stands in for the stiffness of the material
  bool preset_mass = false;            ///< whether the mass is that of the material
  double diameter = 0.0;               ///< of a rope with a material [m]
  MassScene mass;
  SpringMaterials springs;
  std::vector<SpringGroupScene> spring_groups;  ///< in the order of the file
  Placement place;
  std::vector<PinScene> pins;
  std::vector<PointMassScene> point_masses;
  Vector3 velocity = Vector3::Zero();
  ContactMaterial material;
  BodyContact contact;
  bool normals = false;          ///< whether the frames of a mesh have new normals
  bool preserve_volume = false;  ///< of the cells of a solid
  double volume_factor = 0.0;    ///< of a closed mesh, which keeps this multiple of its volume; 0: none
  double pressure = 0.0;         ///< in a closed mesh [Pa]
};

struct ObstacleScene {
  std::string name;
  ObstacleShapeScene shape;
  Placement place;
  Motion motion;
  ContactMaterial material;
};

/// One end of an attachment.
struct AttachmentEndScene {
  std::string body{};               ///< name; empty: an obstacle
  std::optional<Selector> where{};  ///< particles of the body; none: the nearest point of its surface
  std::string obstacle{};           ///< name of the one whose nearest point it is
};

struct AttachmentScene {
  AttachmentEndScene first;
  AttachmentEndScene second;
  std::optional<double> stiffness;                               ///< [N/m]; none: rigid
  double damping = 0.0;                                          ///< [N s/m]
  std::optional<double> rest_length;                             ///< [m]; none: the distance at which it engages
  double break_force = std::numeric_limits<double>::infinity();  ///< [N]
  double from = 0.0;                                             ///< [s]
  double until = std::numeric_limits<double>::infinity();        ///< [s]
};

/// Of a body's mass, which an automatic step may add by default.
inline constexpr double kMassScaling = 0.01;

struct Scene {
  std::filesystem::path file;
  double duration = 0.0;                    ///< [s]
  double frame_rate = 30.0;                 ///< [1/s]
  std::optional<double> step;               ///< [s]; none: "auto"
  double mass_scaling = kMassScaling;       ///< share of a body's mass that may be added for larger steps
  double strength_scatter = 0.02;           ///< of the break strain of bodies with a material, see scatter_strength()
  SimulatorSettings settings;               ///< without the step
  bool air_of_materials = true;             ///< whether bodies with a material have the drag of their shape in air
  std::vector<std::string> limited_bodies;  ///< to which the stretch limit applies; empty: to all
  std::vector<BodyScene> bodies;            ///< in the order of the file
  std::vector<ObstacleScene> obstacles;     ///< in the order of the file
  std::vector<AttachmentScene> attachments;
  std::string initial_state;  ///< folder of the run that the scene begins from; empty: none
  bool write_record = true;   ///< whether a run writes record.bin
  std::string resolved;       ///< the whole scene as JSON text, overrides applied and defaults filled in
};

}  // namespace sprung
