#include "collision/shapes/obstacle.h"
#include "network/network_builder.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/parts.h"
#include "simulation/model.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace py = pybind11;

namespace sprung::python {
namespace {

SpringKind spring_kind(const std::string& name) {
  const auto found = std::ranges::find(kSpringKindNames, name);
  if (found == kSpringKindNames.end()) refuse("kind", name, "must be structural, shear or bend", "choose one");
  return static_cast<SpringKind>(found - kSpringKindNames.begin());
}

ContactMaterial material_of(double thickness, double friction, double restitution) {
  return {.thickness = thickness, .friction = friction, .static_friction = friction, .restitution = restitution};
}

std::vector<Index> indices_of(const py::object& particles) {
  if (py::isinstance<py::int_>(particles)) return {particles.cast<Index>()};
  return particles.cast<std::vector<Index>>();
}

IntegratorSettings integrator_of(const std::string& name) {
  if (name == "explicit_euler") return ExplicitEulerSettings{};
  if (name == "symplectic_euler") return SymplecticEulerSettings{};
  if (name == "verlet") return VerletSettings{};
  if (name == "velocity_verlet") return VelocityVerletSettings{};
  if (name == "runge_kutta_4") return RungeKutta4Settings{};
  if (name == "implicit_euler") return ImplicitEulerSettings{};
  refuse("integrator", name, "must be a scheme",
         "choose explicit_euler, symplectic_euler, verlet, velocity_verlet, runge_kutta_4 or implicit_euler");
}

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

const py::tuple& origin() {
  static const py::tuple* zero = new py::tuple(py::make_tuple(0.0, 0.0, 0.0));  // outlives the interpreter
  return *zero;
}

void bind_network(py::module_& module) {
  py::class_<SpringNetwork>(module, "Network", "Particles, springs, bodies and pins, made by NetworkBuilder.build().")
      .def("__len__", &SpringNetwork::particle_count)
      .def_property_readonly(
          "positions", [](const SpringNetwork& network) { return copy_of(network.positions); },
          "Positions at time 0 [m], (n, 3), read-only.")
      .def_property_readonly(
          "masses",
          [](const SpringNetwork& network) {
            return copy_of(std::span(network.masses.data(), static_cast<std::size_t>(network.masses.size())));
          },
          "[kg], (n,), read-only.");

  py::class_<NetworkBuilder>(module, "NetworkBuilder", R"(NetworkBuilder()

Builds a network particle by particle, or from whole bodies.)")
      .def(py::init<>())
      .def(
          "add_particle",
          [](NetworkBuilder& builder, const py::object& position, double mass, const py::object& velocity) {
            return builder.add_particle(vector_of(position, "position"), mass, vector_of(velocity, "velocity"));
          },
          py::arg("position"), py::arg("mass"), py::arg("velocity") = origin(), R"(add_particle(position, mass, velocity=(0, 0, 0))

Add a particle at a position [m] with a mass [kg] and a velocity [m/s]. Returns its number. Particles belong to a body "network" unless
begin_body() named another.)")
      .def(
          "add_spring",
          [](NetworkBuilder& builder, Index i, Index j, double stiffness, double rest_length, double damping,
             const std::string& kind) { builder.add_spring(i, j, stiffness, rest_length, damping, spring_kind(kind)); },
          py::arg("i"), py::arg("j"), py::arg("stiffness"), py::arg("rest_length"), py::arg("damping") = 0.0,
          py::arg("kind") = "structural", R"(add_spring(i, j, stiffness, rest_length, damping=0.0, kind="structural")

Join two particles of one body: k_s [N/m], rest length [m], k_d [N s/m]; kind: structural, shear or bend.)")
      .def("add_angle_bend", &NetworkBuilder::add_angle_bend, py::arg("before"), py::arg("middle"), py::arg("after"),
           py::arg("stiffness"), py::arg("damping") = 0.0, R"(add_angle_bend(before, middle, after, stiffness, damping=0.0)

Keep three particles in line: k [N m/rad] and a damping of the angle's rate [N m s].)")
      .def(
          "begin_body",
          [](NetworkBuilder& builder, const std::string& name, double thickness, double friction, double restitution) {
            builder.begin_body(name, material_of(thickness, friction, restitution));
          },
          py::arg("name"), py::kw_only(), py::arg("thickness") = 0.0, py::arg("friction") = 0.0, py::arg("restitution") = 0.0,
          R"(begin_body(name, *, thickness=0.0, friction=0.0, restitution=0.0)

Begin a body, to which particles and springs belong that are added later. thickness [m].)")
      .def(
          "add_body",
          [](NetworkBuilder& builder, const std::string& name, const BodyShape& shape, double thickness, double friction,
             double restitution, bool self_contact) {
            return builder.add_body(name, shape, material_of(thickness, friction, restitution), {.self = self_contact});
          },
          py::arg("name"), py::arg("shape"), py::kw_only(), py::arg("thickness") = 0.0, py::arg("friction") = 0.0,
          py::arg("restitution") = 0.0, py::arg("self_contact") = false,
          R"(add_body(name, shape, *, thickness=0.0, friction=0.0, restitution=0.0, self_contact=False)

Add a whole body, of make_rope(), make_cloth() or make_solid(). Returns the number of its first particle. thickness [m].)")
      .def(
          "pin",
          [](NetworkBuilder& builder, const py::object& particles, const std::string& name) {
            Pin pin;
            pin.particles = indices_of(particles);
            pin.name = name;
            builder.add_pin(std::move(pin));
          },
          py::arg("particles"), py::arg("name") = "", R"(pin(particles, name="")

Fix a particle, or several. The name is that of Simulator.pins; without one it is pins[k].)")
      .def("build", &NetworkBuilder::build, "build()\n\nThe network. Raises InputError that names every problem.");
}

void bind_shapes(py::module_& module) {
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
      ("make_rope(points, particles=None, *, mass, structural, bend=None)\n\nA rope along a polyline [m], (k, 3), with so many "
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
      ("make_cloth(size, resolution, *, mass, structural, shear=None, bend=None, position=(0, 0, 0), rotation=(0, 0, 0))\n\nA "
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
      ("make_solid(size, resolution, *, mass, structural, shear=None, bend=None, position=(0, 0, 0), rotation=(0, 0, 0))\n\nA box "
       "[m], centred, with so many particles along x, y and z." +
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
  py::class_<Obstacle>(module, "ObstacleShape",
                       "An obstacle for a simulator of a network: of make_sphere(), make_box() or make_ground().")
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

A box: size (3,), position and thickness [m], rotation [degrees] about the fixed axes x, y, z.)");
  module.def(
      "make_ground",
      [](const std::string& name, double height, double thickness, double friction, double restitution) {
        return make_obstacle(name, HalfSpaceGeometry{.normal = Vector3::UnitY(), .offset = height}, origin(), origin(),
                             material_of(thickness, friction, restitution));
      },
      py::arg("name"), py::kw_only(), py::arg("height") = 0.0, py::arg("thickness") = 0.0, py::arg("friction") = 0.0,
      py::arg("restitution") = 0.0, R"(make_ground(name, *, height=0.0, thickness=0.0, friction=0.0, restitution=0.0)

All below a height [m].)");
}

}  // namespace

void bind_builder(py::module_& module) {
  bind_network(module);
  bind_shapes(module);
  bind_obstacles(module);
  py::class_<ScriptedSimulator, Shared> of_network = module.attr("Simulator");
  of_network.def(py::init([](const SpringNetwork& network, double step, int steps_per_frame, const py::object& gravity,
                             const std::string& integrator, std::vector<Obstacle> obstacles, bool record_forces, bool sleep) {
                   SimulatorSettings settings;
                   settings.step = step;
                   settings.steps_per_frame = steps_per_frame;
                   settings.gravity = vector_of(gravity, "gravity");
                   settings.integrator = integrator_of(integrator);
                   settings.record_forces = record_forces;
                   settings.sleep = sleep;
                   auto simulator =
                       std::make_shared<ScriptedSimulator>(Simulator(network, settings, std::move(obstacles)), nullptr);
                   for (const std::string& text : simulator->peek().warnings()) warn(text);
                   return simulator;
                 }),
                 py::arg("network"), py::kw_only(), py::arg("step") = 0.001, py::arg("steps_per_frame") = 1,
                 py::arg("gravity") = py::make_tuple(0.0, -9.81, 0.0), py::arg("integrator") = "verlet",
                 py::arg("obstacles") = std::vector<Obstacle>(), py::arg("record_forces") = false, py::arg("sleep") = true);
}

}  // namespace sprung::python
