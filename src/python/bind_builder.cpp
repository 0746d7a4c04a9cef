#include "collision/shapes/obstacle.h"
#include "network/network_builder.h"
#include "python/bindings.h"
#include "python/parts.h"
#include "python/shape_arguments.h"
#include "python/simulator/arrays.h"
#include "python/simulator/errors.h"
#include "simulation/model.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace py = pybind11;

namespace sprung::python {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

SpringKind spring_kind(const std::string& name) {
  const auto found = std::ranges::find(kSpringKindNames, name);
  if (found == kSpringKindNames.end()) refuse("kind", name, "must be structural, shear or bend", "choose one");
  return static_cast<SpringKind>(found - kSpringKindNames.begin());
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

/// Keyframes: (time, position) or (time, position, rotation).
Motion motion_of(const py::object& keyframes, bool smooth, const py::object& spin) {
  Motion motion{.interpolation = smooth ? Interpolation::smooth : Interpolation::linear, .spin = vector_of(spin, "spin")};
  for (const py::handle& each : keyframes) {
    const std::string key = "keyframes[" + std::to_string(motion.keyframes.size()) + "]";
    const auto parts = py::isinstance<py::sequence>(each) ? each.cast<py::list>() : py::list();
    if (parts.size() != 2 && parts.size() != 3) {
      refuse(key, type_name(each), "must be a time, a position and, if it rotates, a rotation",
             "give (time, position) or (time, position, rotation)");
    }
    Keyframe& keyframe = motion.keyframes.emplace_back();
    keyframe.time = numbers_of(parts[0], key + ".time", 1).front();
    keyframe.position = vector_of(parts[1], key + ".position");
    if (parts.size() == 3) keyframe.rotation = vector_of(parts[2], key + ".rotation");
  }
  return motion;
}

void add_pin(NetworkBuilder& builder, const py::object& particles, const std::string& name, const py::object& keyframes,
             bool smooth, const py::object& spin, const py::object& origin, const std::optional<Index>& obstacle, double begin,
             const std::optional<double>& until) {
  Pin pin{.particles = indices_of(particles, "particles"),
          .origin = vector_of(origin, "origin"),
          .motion = motion_of(keyframes, smooth, spin),
          .obstacle = obstacle.value_or(kNone),
          .from = begin,
          .until = until.value_or(kNever),
          .name = name};
  if (obstacle && *obstacle < 0) {
    refuse("obstacle", std::to_string(*obstacle), "must be the number of an obstacle",
           "count the obstacles of the simulator from 0");
  }
  if (obstacle && pin.motion.moves()) {
    refuse("obstacle", std::to_string(*obstacle), "cannot be there beside a motion: the pin follows one of them",
           "give one of both");
  }
  builder.add_pin(std::move(pin));
}

void add_attachment(NetworkBuilder& builder, const py::object& first, const py::object& particles, const std::optional<Index>& body,
                    const std::optional<Index>& obstacle, const std::optional<double>& stiffness, double damping,
                    const std::optional<double>& rest_length, const std::optional<double>& break_force, double begin,
                    const std::optional<double>& until, const std::string& name) {
  if (int{!particles.is_none()} + int{body.has_value()} + int{obstacle.has_value()} != 1) {
    refuse("second end", "", "must be one of particles, a body and an obstacle", "give one of particles=, body= and obstacle=");
  }
  Attachment attachment{.name = name,
                        .particles = indices_of(first, "first"),
                        .second = {},
                        .stiffness = stiffness,
                        .damping = damping,
                        .rest_length = rest_length,
                        .break_force = break_force.value_or(kNever),
                        .from = begin,
                        .until = until.value_or(kNever)};
  if (body) {
    attachment.second = SurfaceEnd{*body};
  } else if (obstacle) {
    attachment.second = ObstacleEnd{*obstacle};
  } else {
    attachment.second = ParticleEnds{indices_of(particles, "particles")};
  }
  builder.add_attachment(std::move(attachment));
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

  py::class_<NetworkBuilder>(module, "NetworkBuilder", "Builds a network particle by particle, or from whole bodies.")
      .def(py::init<>(), "__init__(self)\n--\n\nWithout particles.")
      .def(
          "add_particle",
          [](NetworkBuilder& builder, const py::object& position, double mass, const py::object& velocity) {
            return builder.add_particle(vector_of(position, "position"), mass, vector_of(velocity, "velocity"));
          },
          py::arg("position"), py::arg("mass"), py::arg("velocity") = origin(),
          R"(add_particle(self, position, mass, velocity=(0, 0, 0))
--

Add a particle at a position [m] with a mass [kg] and a velocity [m/s]. Returns its number. Particles belong to a body "network" unless
begin_body() named another.)")
      .def(
          "add_spring",
          [](NetworkBuilder& builder, Index i, Index j, double stiffness, double rest_length, double damping,
             const std::string& kind, bool tension_only, const std::optional<double>& yield_strain,
             const std::optional<double>& break_length) {
            builder.add_spring(i, j, stiffness, rest_length, damping, spring_kind(kind),
                               {.tension_only = tension_only,
                                .yield = yield_strain.value_or(kNever),
                                .break_length = break_length.value_or(kNever)});
          },
          py::arg("i"), py::arg("j"), py::arg("stiffness"), py::arg("rest_length"), py::arg("damping") = 0.0,
          py::arg("kind") = "structural", py::kw_only(), py::arg("tension_only") = false, py::arg("yield_strain") = py::none(),
          py::arg("break_length") = py::none(),
          R"(add_spring(self, i, j, stiffness, rest_length, damping=0.0, kind="structural", *, tension_only=False, yield_strain=None,
           break_length=None)
--

Join two particles of one body: k_s [N/m], rest length [m], k_d [N s/m]; kind: structural, shear or bend. A spring of
tension_only does not push. Beyond yield_strain (a fraction of the rest length) it keeps a new rest length; beyond break_length
[m] it breaks; None: never.)")
      .def("add_angle_bend", &NetworkBuilder::add_angle_bend, py::arg("before"), py::arg("middle"), py::arg("after"),
           py::arg("stiffness"), py::arg("damping") = 0.0, R"(add_angle_bend(self, before, middle, after, stiffness, damping=0.0)
--

Keep three particles in line: k [N m/rad] and a damping of the angle's rate [N m s].)")
      .def(
          "begin_body",
          [](NetworkBuilder& builder, const std::string& name, double thickness, double friction, double restitution,
             bool self_contact, bool body_contact) {
            builder.begin_body(name, material_of(thickness, friction, restitution), {.self = self_contact, .others = body_contact});
          },
          py::arg("name"), py::kw_only(), py::arg("thickness") = 0.0, py::arg("friction") = 0.0, py::arg("restitution") = 0.0,
          py::arg("self_contact") = false, py::arg("body_contact") = true,
          R"(begin_body(self, name, *, thickness=0.0, friction=0.0, restitution=0.0, self_contact=False, body_contact=True)
--

Begin a body, to which particles and springs belong that are added later. thickness [m]. self_contact: it collides with itself;
body_contact: with other bodies.)")
      .def(
          "add_body",
          [](NetworkBuilder& builder, const std::string& name, const BodyShape& shape, double thickness, double friction,
             double restitution, bool self_contact, bool body_contact) {
            return builder.add_body(name, shape, material_of(thickness, friction, restitution),
                                    {.self = self_contact, .others = body_contact});
          },
          py::arg("name"), py::arg("shape"), py::kw_only(), py::arg("thickness") = 0.0, py::arg("friction") = 0.0,
          py::arg("restitution") = 0.0, py::arg("self_contact") = false, py::arg("body_contact") = true,
          R"(add_body(self, name, shape, *, thickness=0.0, friction=0.0, restitution=0.0, self_contact=False, body_contact=True)
--

Add a whole body, of make_rope(), make_cloth(), make_solid() or make_mesh(). Returns the number of its first particle. The other
arguments are those of begin_body().)")
      .def("pin", &add_pin, py::arg("particles"), py::arg("name") = "", py::kw_only(), py::arg("keyframes") = py::tuple(),
           py::arg("smooth") = false, py::arg("spin") = origin(), py::arg("origin") = origin(), py::arg("obstacle") = py::none(),
           py::arg("begin") = 0.0, py::arg("until") = py::none(),
           R"(pin(self, particles, name="", *, keyframes=(), smooth=False, spin=(0, 0, 0), origin=(0, 0, 0),
    obstacle=None, begin=0.0, until=None)
--

Fix a particle, or several. The name is that of Simulator.pins; without one it is pins[k].

keyframes: tuples (time [s], displacement [m]) or (time, displacement, rotation [degrees] about the fixed axes x, y, z) move them;
between two keyframes on a line, or smoothly. spin [degrees/s] rotates without end. Both rotate about origin [m]. obstacle: the
number of an obstacle of the simulator, which the particles follow instead. begin, until [s]: when the pin holds; None: for ever.)")
      .def(
          "add_attachment", &add_attachment, py::arg("first"), py::kw_only(), py::arg("particles") = py::none(),
          py::arg("body") = py::none(), py::arg("obstacle") = py::none(), py::arg("stiffness") = py::none(),
          py::arg("damping") = 0.0, py::arg("rest_length") = py::none(), py::arg("break_force") = py::none(),
          py::arg("begin") = 0.0, py::arg("until") = py::none(), py::arg("name") = "",
          R"(add_attachment(self, first, *, particles=None, body=None, obstacle=None, stiffness=None, damping=0.0, rest_length=None,
               break_force=None, begin=0.0, until=None, name="")
--

Join each particle of first, a number or several, to the nearest of these points when the attachment begins: of particles, of
the surface of a body (its number, counted from 0 as bodies were added), or of the surface of an obstacle of the simulator (its
number). Give one of the three.

A spring has a stiffness [N/m] and a damping [N s/m]; without a stiffness it is a rod. rest_length [m]; None: the distance at the
begin. Beyond break_force [N] it breaks; None: never. begin, until [s]: when it holds; None: for ever. The name is that of
Simulator.forces().)")
      .def("build", &NetworkBuilder::build, "build(self)\n--\n\nThe network. Raises InputError that names every problem.");
}

}  // namespace

void bind_builder(py::module_& module) {
  bind_shapes(module);
  bind_network(module);
  py::class_<ScriptedSimulator, Shared> of_network = module.attr("Simulator");
  of_network.def(
      py::init([](const py::object& network, double step, int steps_per_frame, const py::object& gravity,
                  const std::string& integrator, std::vector<Obstacle> obstacles, bool record_forces, bool sleep) {
        if (!py::isinstance<SpringNetwork>(network)) {
          refuse("network", type_name(network), "must be a Network, as NetworkBuilder.build() makes it",
                 "of a scene: sprung.load(scene).simulator()");
        }
        SimulatorSettings settings;
        settings.step = step;
        settings.steps_per_frame = steps_per_frame;
        settings.gravity = vector_of(gravity, "gravity");
        settings.integrator = integrator_of(integrator);
        settings.record_forces = settings.record_contact_forces = record_forces;
        settings.sleep = sleep;
        auto simulator = std::make_shared<ScriptedSimulator>(
            Simulator(network.cast<const SpringNetwork&>(), settings, std::move(obstacles)), nullptr);
        for (const std::string& text : simulator->peek().warnings()) warn(text);
        return simulator;
      }),
      py::arg("network"), py::kw_only(), py::arg("step") = 0.001, py::arg("steps_per_frame") = 1,
      py::arg("gravity") = py::make_tuple(0.0, -9.81, 0.0), py::arg("integrator") = "verlet",
      py::arg("obstacles") = std::vector<Obstacle>(), py::arg("record_forces") = false, py::arg("sleep") = true,
      R"(__init__(self, network, *, step=0.001, steps_per_frame=1, gravity=(0, -9.81, 0), integrator="verlet", obstacles=(),
         record_forces=False, sleep=True)
--

Of a network. step [s], gravity [m/s^2]; integrator: explicit_euler, symplectic_euler, verlet, velocity_verlet, runge_kutta_4 or
implicit_euler; obstacles: a list of ObstacleShape. record_forces: for forces() and contact_forces(). sleep: bodies at rest cost
nothing. Raises InputError for a step that is too large.)");
}

}  // namespace sprung::python
