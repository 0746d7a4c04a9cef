#include "collision/shapes/obstacle.h"
#include "geometry/import/mesh_import.h"
#include "network/bodies/body_shape.h"
#include "python/bindings.h"
#include "python/shape_arguments.h"
#include "python/simulator/arrays.h"
#include "python/simulator/errors.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace py = pybind11;

namespace sprung::python {
namespace {

/// Springs of one kind: a stiffness [N/m], or a stiffness and a damping [N s/m].
std::optional<SpringMaterial> springs_of(const py::object& value, const std::string& key) {
  if (value.is_none()) return std::nullopt;
  const std::vector<double> numbers =
      numbers_of(py::isinstance<py::sequence>(value) ? value : py::make_tuple(value, 0.0), "springs." + key, 2);
  return SpringMaterial{.value = numbers[0], .damping = numbers[1]};
}

SpringMaterials materials_of(const py::object& structural, const py::object& shear, const py::object& bend) {
  return {
      .structural = springs_of(structural, "structural"), .shear = springs_of(shear, "shear"), .bend = springs_of(bend, "bend")};
}

BodyShape placed(BodyShape shape, double mass, const py::object& position, const py::object& rotation) {
  set_total_mass(shape, mass);
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation_from_degrees(vector_of(rotation, "rotation"));
  pose.translation() = vector_of(position, "position");
  place(shape, pose);
  return shape;
}

/// A mesh as a program gives it: the path of a file, or vertices [m], (n, 3), and faces as vertex numbers.
using GivenMesh = std::variant<std::filesystem::path, PolygonMesh>;

PolygonFaces faces_of(const py::object& value) {
  std::vector<std::vector<Index>> given;
  try {
    given = (py::hasattr(value, "tolist") ? value.attr("tolist")() : value).cast<std::vector<std::vector<Index>>>();
  } catch (const py::cast_error&) {
    refuse("mesh.faces", type_name(value), "must be a list of faces, each a list of vertex numbers",
           "give an array (f, 3), or lists");
  }
  PolygonFaces faces;
  for (const std::vector<Index>& face : given) {
    faces.vertex.insert(faces.vertex.end(), face.begin(), face.end());
    faces.corner_begin.push_back(static_cast<Index>(faces.vertex.size()));
  }
  return faces;
}

GivenMesh mesh_of(const py::object& value) {
  if (py::isinstance<py::tuple>(value) || py::isinstance<py::list>(value)) {
    const auto parts = value.cast<py::sequence>();
    if (parts.size() != 2) {
      refuse("mesh", std::to_string(parts.size()) + " parts", "must be a path, or vertices and faces", "give (vertices, faces)");
    }
    return PolygonMesh{.vertices = points_of(parts[0], "mesh.vertices"), .faces = faces_of(parts[1]), .lines = Edges(2, 0)};
  }
  try {
    return std::filesystem::path(py::module_::import("os").attr("fspath")(value).cast<std::string>());
  } catch (const py::error_already_set&) {
    refuse("mesh", type_name(value), "must be a path, or vertices and faces", "give (vertices, faces)");
  }
}

MeshGeometry obstacle_mesh(const std::string& name, const GivenMesh& given) {
  ImportedMesh imported;
  if (const auto* file = std::get_if<std::filesystem::path>(&given)) {
    imported = import_mesh(*file);
  } else {
    const PolygonMesh& mesh = std::get<PolygonMesh>(given);
    static_cast<void>(make_mesh_body(mesh, {}));  // checks it
    imported = clean_mesh({.vertices = mesh.vertices, .triangles = triangulate(mesh.faces)});
  }
  for (const std::string& note : imported.report.notes) warn("obstacle \"" + name + "\": " + note);
  return {.mesh = std::make_shared<const TriangleMesh>(std::move(imported.mesh)), .closed = imported.report.closed};
}

void bind_bodies(py::module_& module) {
  py::class_<BodyShape>(module, "BodyShape", "Particles, springs and surface of a body, for NetworkBuilder.add_body().")
      .def("__len__", [](const BodyShape& shape) { return shape.positions.size(); });

  const std::string springs =
      "structural, shear, bend: k_s [N/m], or (k_s, k_d [N s/m]); None: no such springs. mass [kg] of the whole body.";
  const std::string pose = " It is rotated by angles [degrees] about the fixed axes x, y, z, then moved [m].";
  module.def(
      "make_rope",
      [](const py::object& points, std::optional<Index> particles, double mass, const py::object& structural,
         const py::object& bend) {
        const Points corners = points_of(points, "points");
        RopeShape rope{.points = {}, .particles = particles, .length = {}};
        for (Index i = 0; i < corners.cols(); ++i) rope.points.emplace_back(corners.col(i));
        BodyShape shape = make_rope(rope, materials_of(structural, py::none(), bend));
        set_total_mass(shape, mass);
        return shape;
      },
      py::arg("points"), py::arg("particles") = py::none(), py::kw_only(), py::arg("mass"), py::arg("structural"),
      py::arg("bend") = py::none(),
      ("make_rope(points, particles=None, *, mass, structural, bend=None)\n--\n\nA rope along a polyline [m], (k, 3), with so many "
       "particles, or one at each point. " +
       springs)
          .c_str());
  module.def(
      "make_cloth",
      [](const std::array<double, 2>& size, const std::array<Index, 2>& resolution, double mass, const py::object& structural,
         const py::object& shear, const py::object& bend, const py::object& position, const py::object& rotation) {
        return placed(make_cloth({.size = size, .resolution = resolution}, materials_of(structural, shear, bend)), mass, position,
                      rotation);
      },
      py::arg("size"), py::arg("resolution"), py::kw_only(), py::arg("mass"), py::arg("structural"), py::arg("shear") = py::none(),
      py::arg("bend") = py::none(), py::arg("position") = origin(), py::arg("rotation") = origin(),
      ("make_cloth(size, resolution, *, mass, structural, shear=None, bend=None, position=(0, 0, 0), rotation=(0, 0, 0))\n--\n\nA "
       "rectangle [m] in the x-y plane, centred, with so many particles along x and y." +
       pose + " " + springs)
          .c_str());
  module.def(
      "make_solid",
      [](const std::array<double, 3>& size, const std::array<Index, 3>& resolution, double mass, const py::object& structural,
         const py::object& shear, const py::object& bend, const py::object& position, const py::object& rotation) {
        const SolidShape solid{.size = Vector3(size[0], size[1], size[2]), .resolution = resolution};
        return placed(make_solid(solid, materials_of(structural, shear, bend)), mass, position, rotation);
      },
      py::arg("size"), py::arg("resolution"), py::kw_only(), py::arg("mass"), py::arg("structural"), py::arg("shear") = py::none(),
      py::arg("bend") = py::none(), py::arg("position") = origin(), py::arg("rotation") = origin(),
      ("make_solid(size, resolution, *, mass, structural, shear=None, bend=None, position=(0, 0, 0), rotation=(0, 0, 0))\n--\n\nA "
       "box "
       "[m], centred, with so many particles along x, y and z." +
       pose + " " + springs)
          .c_str());
  module.def(
      "make_mesh",
      [](const py::object& mesh, double mass, const py::object& structural, const py::object& shear, const py::object& bend,
         const py::object& position, const py::object& rotation) {
        const GivenMesh given = mesh_of(mesh);
        const auto* file = std::get_if<std::filesystem::path>(&given);
        const SpringMaterials materials = materials_of(structural, shear, bend);
        return placed(make_mesh_body(file != nullptr ? read_obj(*file) : std::get<PolygonMesh>(given), materials), mass, position,
                      rotation);
      },
      py::arg("mesh"), py::kw_only(), py::arg("mass"), py::arg("structural"), py::arg("shear") = py::none(),
      py::arg("bend") = py::none(), py::arg("position") = origin(), py::arg("rotation") = origin(),
      ("make_mesh(mesh, *, mass, structural, shear=None, bend=None, position=(0, 0, 0), rotation=(0, 0, 0))\n--\n\nA mesh with a "
       "particle at each vertex: the path of an OBJ file, or (vertices, faces) with vertices [m], (n, 3), and faces as lists of "
       "vertex numbers, or an array (f, 3)." +
       pose + " " + springs)
          .c_str());
}

Obstacle make_obstacle(const std::string& name, ObstacleGeometry geometry, const py::object& position, const py::object& rotation,
                       const ContactMaterial& material) {
  Obstacle obstacle{.name = name, .geometry = std::move(geometry), .material = material};
  obstacle.rest_pose.linear() = rotation_from_degrees(vector_of(rotation, "rotation"));
  obstacle.rest_pose.translation() = vector_of(position, "position");
  return obstacle;
}

void bind_obstacles(py::module_& module) {
  py::class_<Obstacle>(
      module, "ObstacleShape",
      "An obstacle for a simulator of a network: of make_sphere(), make_box(), make_ground() or make_mesh_obstacle().")
      .def_readonly("name", &Obstacle::name, "Its name.");
  module.def(
      "make_sphere",
      [](const std::string& name, double radius, const py::object& position, double thickness, double friction,
         double restitution) {
        return make_obstacle(name, SphereGeometry{radius}, position, origin(), material_of(thickness, friction, restitution));
      },
      py::arg("name"), py::arg("radius"), py::kw_only(), py::arg("position") = origin(), py::arg("thickness") = 0.0,
      py::arg("friction") = 0.0, py::arg("restitution") = 0.0,
      R"(make_sphere(name, radius, *, position=(0, 0, 0), thickness=0.0, friction=0.0, restitution=0.0)
--

A sphere: radius, position and thickness [m].)");
  module.def(
      "make_box",
      [](const std::string& name, const py::object& size, const py::object& position, const py::object& rotation, double thickness,
         double friction, double restitution) {
        return make_obstacle(name, BoxGeometry{vector_of(size, "size")}, position, rotation,
                             material_of(thickness, friction, restitution));
      },
      py::arg("name"), py::arg("size"), py::kw_only(), py::arg("position") = origin(), py::arg("rotation") = origin(),
      py::arg("thickness") = 0.0, py::arg("friction") = 0.0, py::arg("restitution") = 0.0,
      R"(make_box(name, size, *, position=(0, 0, 0), rotation=(0, 0, 0), thickness=0.0, friction=0.0, restitution=0.0)
--

A box: size (3,), position and thickness [m], rotation [degrees] about the fixed axes x, y, z.)");
  module.def(
      "make_mesh_obstacle",
      [](const std::string& name, const py::object& mesh, const py::object& position, const py::object& rotation, double thickness,
         double friction, double restitution) {
        return make_obstacle(name, obstacle_mesh(name, mesh_of(mesh)), position, rotation,
                             material_of(thickness, friction, restitution));
      },
      py::arg("name"), py::arg("mesh"), py::kw_only(), py::arg("position") = origin(), py::arg("rotation") = origin(),
      py::arg("thickness") = 0.0, py::arg("friction") = 0.0, py::arg("restitution") = 0.0,
      R"(make_mesh_obstacle(name, mesh, *, position=(0, 0, 0), rotation=(0, 0, 0), thickness=0.0, friction=0.0, restitution=0.0)
--

A mesh: the path of an OBJ, STL, PLY, OFF, glTF or 3DS file, or (vertices, faces) as of make_mesh(). A closed mesh has an inside;
of an open one, each particle stays on its side. position and thickness [m], rotation [degrees] about the fixed axes x, y, z.)");
  module.def(
      "make_ground",
      [](const std::string& name, double height, double thickness, double friction, double restitution) {
        return make_obstacle(name, HalfSpaceGeometry{.normal = Vector3::UnitY(), .offset = height}, origin(), origin(),
                             material_of(thickness, friction, restitution));
      },
      py::arg("name"), py::kw_only(), py::arg("height") = 0.0, py::arg("thickness") = 0.0, py::arg("friction") = 0.0,
      py::arg("restitution") = 0.0, R"(make_ground(name, *, height=0.0, thickness=0.0, friction=0.0, restitution=0.0)
--

All below a height [m].)");
}

}  // namespace

const py::tuple& origin() {
  static const py::tuple* zero = new py::tuple(py::make_tuple(0.0, 0.0, 0.0));  // outlives the interpreter
  return *zero;
}

ContactMaterial material_of(double thickness, double friction, double restitution) {
  return {.thickness = thickness, .friction = friction, .static_friction = friction, .restitution = restitution};
}

void bind_shapes(py::module_& module) {
  bind_bodies(module);
  bind_obstacles(module);
}

}  // namespace sprung::python
