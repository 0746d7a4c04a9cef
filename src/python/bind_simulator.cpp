#include "base/format.h"
#include "collision/obstacles/obstacle_frame.h"
#include "dynamics/state/simulation_state.h"
#include "python/bindings.h"
#include "python/fast_step.h"
#include "python/parts.h"
#include "python/simulator/arrays.h"
#include "python/simulator/batch.h"
#include "python/simulator/changes.h"
#include "python/simulator/errors.h"
#include "python/simulator/saved_simulator.h"
#include "simulation/checkpoint.h"
#include "simulation/model.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace py = pybind11;

namespace sprung::python {
namespace {

constexpr int kTimeDigits = 9;  // the last ones of a sum of steps are rounding

/// A state with its caches, as copies share it.
struct StateSnapshot {
  std::shared_ptr<const Checkpoint> checkpoint;
  double time = 0.0;
};

StateSnapshot state_of(ScriptedSimulator& simulator) {
  const Simulator& read = simulator.read();
  return {.checkpoint = std::make_shared<const Checkpoint>(read.checkpoint()), .time = read.time()};
}

py::array diagnostics_table(const FrameDiagnostics& d) {
  const auto number = [](const char* name, double value) { return Column{name, py::str("f8"), py::float_(value)}; };
  const auto count = [](const char* name, std::int64_t value) { return Column{name, py::str("i8"), py::int_(value)}; };
  const double distance = d.min_distance.value_or(std::numeric_limits<double>::quiet_NaN());
  return table_of(1, {count("frame", d.frame), number("time", d.time), number("kinetic_energy", d.kinetic_energy),
                      number("elastic_energy", d.elastic_energy), number("gravity_energy", d.gravity_energy),
                      number("contact_energy", d.contact_energy), number("max_stretch", d.max_stretch),
                      number("stretch_excess", d.stretch_excess), count("contacts", d.contacts), number("min_distance", distance),
                      count("truncated", d.truncated), count("infeasible", d.infeasible), count("inverted_cells", d.inverted_cells),
                      count("substeps", d.substeps), number("smallest_step", d.smallest_step),
                      count("limit_solves", d.limit_solves), number("frame_ms", d.frame_ms)});
}

py::array diagnostics(ScriptedSimulator& simulator) { return diagnostics_table(present_diagnostics(simulator.read())); }

/// The obstacle that a contact is with; kNone: between bodies.
Index touched_obstacle(const ObstacleFrame& obstacles, const ContactNormal& touching, double thickness, const Vector3& position) {
  constexpr double kAlike = 0.99;  // of two normals, as the state has none of obstacles
  Index found = kNone;
  double most = kAlike;
  for (Index k = 0; k < static_cast<Index>(obstacles.set().obstacles().size()); ++k) {
    const double gap = thickness + obstacles.obstacle(k).material.thickness;
    const auto contact =
        find_contact(obstacles, k,
                     {.particle = touching.particle, .before = position, .after = position, .thickness = thickness, .margin = gap});
    if (!contact || contact->normal.dot(touching.normal) < most) continue;
    most = contact->normal.dot(touching.normal);
    found = k;
  }
  return found;
}

py::array contacts(ScriptedSimulator& simulator) {
  const Simulator& read = simulator.read();
  const SpringNetwork& network = read.network();
  const ContactMemory& contact = read.state().contact;
  std::vector<Index> bodies;
  std::vector<Index> particles;
  std::vector<Index> obstacles;
  Points normals(3, static_cast<Eigen::Index>(contact.normals.size()));
  const ObstacleFrame now = read.obstacle_frame();
  for (const ContactNormal& touching : contact.normals) {
    const Body& body = network.body_of(touching.particle);
    normals.col(static_cast<Eigen::Index>(bodies.size())) = touching.normal;
    bodies.push_back(static_cast<Index>(&body - network.bodies.data()));
    particles.push_back(touching.particle - body.first_particle);
    obstacles.push_back(touched_obstacle(now, touching, body.material.thickness, read.positions().col(touching.particle)));
  }
  std::vector<std::string> body_names;
  for (const Body& body : network.bodies) body_names.push_back(body.name);
  std::vector<std::string> obstacle_names;
  for (const Obstacle& obstacle : read.obstacles()) obstacle_names.push_back(obstacle.name);
  const py::array body_column = names_of(body_names, bodies);
  const py::array obstacle_column = names_of(obstacle_names, obstacles);
  return table_of(static_cast<Index>(particles.size()), {{"body", body_column.dtype(), body_column},
                                                         {"particle", py::str("i4"), copy_of(std::span<const Index>(particles))},
                                                         {"obstacle", obstacle_column.dtype(), obstacle_column},
                                                         {"normal", py::make_tuple("f8", py::make_tuple(3)), copy_of(normals)}});
}

void require_forces(bool recorded) {
  if (recorded) return;
  refuse("output.forces", "false", "must be true, so that steps record forces",
         "load the scene with overrides={\"output.forces\": True}, or make the simulator with record_forces=True");
}

py::array contact_forces(ScriptedSimulator& simulator) {
  const Simulator& read = simulator.read();
  require_forces(read.settings().record_contact_forces);
  return copy_of(read.contact_forces());
}

py::array forces(ScriptedSimulator& simulator) {
  const Simulator& read = simulator.read();
  require_forces(read.settings().record_forces);
  const std::vector<Reaction> reactions = read.reactions();
  std::vector<std::string> names;
  std::vector<Index> numbers;
  Points means(3, static_cast<Eigen::Index>(reactions.size()));
  for (const Reaction& reaction : reactions) {
    means.col(static_cast<Eigen::Index>(names.size())) = reaction.force;
    numbers.push_back(static_cast<Index>(names.size()));
    names.push_back(reaction.name);
  }
  const py::array column = names_of(names, numbers);
  return table_of(static_cast<Index>(names.size()),
                  {{"name", column.dtype(), column}, {"force", py::make_tuple("f8", py::make_tuple(3)), copy_of(means)}});
}

/// The particle of a body, in the numbering of the network.
Index particle_of(const SpringNetwork& network, const std::string& name, Index particle) {
  const auto body = std::ranges::find(network.bodies, name, &Body::name);
  if (body == network.bodies.end()) refuse("bodies." + name, "", "is no body of the simulator", "see simulator.bodies");
  if (particle < 0 || particle >= body->particle_count) {
    refuse("bodies." + name + ".particles", std::to_string(particle),
           "must be the number of a particle; there are " + std::to_string(body->particle_count), "count particles from 0");
  }
  return body->first_particle + particle;
}

PinPart pin(const Shared& simulator, const std::string& body, const py::object& particles, const std::string& name) {
  const std::vector<Index> numbers = indices_of(particles, "bodies." + body + ".particles");
  const std::size_t number = simulator->change([&](Simulator& changed) {
    std::vector<Index> held;
    for (const Index i : numbers) held.push_back(particle_of(changed.network(), body, i));
    return changed.pin(held, name);
  });
  return {simulator, number};
}

void release(ScriptedSimulator& simulator, const std::string& body, const py::object& particles) {
  const std::vector<Index> numbers = indices_of(particles, "bodies." + body + ".particles");
  simulator.change([&](Simulator& changed) {
    std::vector<Index> freed;
    for (const Index i : numbers) freed.push_back(particle_of(changed.network(), body, i));
    for (const Index i : freed) changed.release(i);
  });
}

std::string text_of(ScriptedSimulator& simulator) {
  const Simulator& read = simulator.peek();
  std::string names;
  for (const Body& body : read.network().bodies) names += (names.empty() ? "" : ", ") + body.name;
  return "<sprung.Simulator of " + names + " at " + format_number(read.time(), kTimeDigits) + " s>";
}

void bind_state(py::module_& module) {
  py::class_<StateSnapshot>(module, "State", R"(A state of a simulator, with all that decides how it continues.

Simulator.restore continues from it, bit by bit. It never changes.)")
      .def("__repr__",
           [](const StateSnapshot& state) {
             return "<sprung.State of " + counted(static_cast<std::size_t>(state.checkpoint->state.x.cols()), "particle") + " at " +
                    format_number(state.time, kTimeDigits) + " s>";
           })
      .def_readonly("time", &StateSnapshot::time, "Time [s].")
      .def_property_readonly(
          "positions", [](const StateSnapshot& state) { return copy_of(state.checkpoint->state.x); },
          "Positions of all particles [m], (n, 3), a read-only copy.")
      .def_property_readonly(
          "velocities", [](const StateSnapshot& state) { return copy_of(state.checkpoint->state.v); },
          "Velocities of all particles [m/s], (n, 3), a read-only copy.")
      .def(
          "__deepcopy__", [](const py::object& self, const py::dict& /*memo*/) { return self; }, py::arg("memo"))
      .def(
          "__eq__", [](const StateSnapshot& a, const StateSnapshot& b) { return a.checkpoint->state == b.checkpoint->state; },
          py::arg("other"), py::is_operator(), "Whether both states are equal bit by bit.")
      .def(
          "__hash__", [](const StateSnapshot& state) { return static_cast<std::int64_t>(hash(state.checkpoint->state) >> 2); },
          "Equal states have the same number.");
}

Batch batch_of(const py::iterable& simulators) {
  std::vector<Shared> all;
  for (const py::handle& each : simulators) {
    if (!py::isinstance<ScriptedSimulator>(each)) {
      refuse("simulators[" + std::to_string(all.size()) + "]", type_name(each), "must be a Simulator",
             "make it by sprung.load(scene).simulator()");
    }
    all.push_back(each.cast<Shared>());
  }
  return Batch(std::move(all));
}

void bind_batch(py::module_& module) {
  py::class_<Batch>(module, "Batch", "Many simulators that step at once, on all cores. Each gets the same bits as alone.")
      .def(py::init(&batch_of), py::arg("simulators"), "__init__(self, simulators)\n--\n\nOf a list of simulators, each once.")
      .def("step", &Batch::step, py::arg("steps") = 1, R"(step(self, steps=1)
--

Make so many steps of each simulator. If one fails, it stays at the begin of its step, the others go on, and the error of the
first that failed is raised. Ctrl-C stops each at the begin of a step.)")
      .def("frame", &Batch::frame, "frame(self)\n--\n\nMake the steps of each simulator to the end of its frame.")
      .def_property_readonly("simulators", &Batch::simulators, "The simulators, in order.")
      .def("__len__", [](const Batch& batch) { return batch.simulators().size(); });
}

}  // namespace

void bind_simulator(py::module_& module) {
  bind_state(module);
  py::class_<ScriptedSimulator, Shared> simulator(
      module, "Simulator",
      R"(A simulation that steps, made by Scene.simulator(), by sprung.restore(), or of a Network.

Steps run without the interpreter's lock, so several threads may step several simulators. A simulator that is stepping is
refused to other threads, by RuntimeError. It cannot be pickled: a process loads its scene itself, or a file of save().)");
  simulator
      .def(
          "frame", [](ScriptedSimulator& self) { return diagnostics_table(self.frame()); }, R"(frame(self)
--

Make the steps to the end of the present frame. Returns its diagnostics: a structured array of one row, with energies [J], the
largest stretch, counts of contacts and so on, as the columns of diagnostics.csv. Raises as step().)")
      .def("diagnostics", &diagnostics, R"(diagnostics(self)
--

The diagnostics of the present, as of frame(): (1,), with 0 where a number is one of the steps of a frame.)")
      .def_property_readonly(
          "time", [](const ScriptedSimulator& self) { return self.peek().time(); }, "Time [s].")
      .def_property_readonly(
          "frame_number", [](const ScriptedSimulator& self) { return self.peek().state().frame + 1; },
          "The number of the last complete frame; frame 1 is the state at time 0.")
      .def_property_readonly(
          "step_length", [](const ScriptedSimulator& self) { return self.peek().settings().step; }, "Length of a step [s].")
      .def_property_readonly(
          "steps_per_frame", [](const ScriptedSimulator& self) { return self.peek().settings().steps_per_frame; },
          "Number of steps of a frame.")
      .def_property_readonly("bodies", &bodies_of, "The bodies, by name.")
      .def_property_readonly("pins", &pins_of, "The pins, by name.")
      .def_property_readonly("obstacles", &obstacles_of, "The obstacles, by name.")
      .def_property(
          "gravity",
          [](const ScriptedSimulator& self) { return py::array(copy_of(Points(self.peek().settings().gravity))[py::int_(0)]); },
          &set_gravity, "Acceleration of gravity [m/s^2], (3,). Assign it to change it for the next steps.")
      .def_property_readonly(
          "kinetic_energy", [](ScriptedSimulator& self) { return kinetic_energy(self.read()); }, "[J]")
      .def_property_readonly(
          "elastic_energy", [](ScriptedSimulator& self) { return self.read().elastic_energy(); },
          "Of springs, attachments and bends [J].")
      .def_property_readonly(
          "gravity_energy", [](ScriptedSimulator& self) { return self.read().gravity_energy(); }, "Sum of -m g . x [J].")
      .def("contacts", &contacts, R"(contacts(self)
--

What touches at the end of the last step: a structured array with a row for each touching contact of a particle. Fields: body
(text), particle (number within the body), obstacle (text; empty for contact between bodies), normal (unit vector towards the side
to which the contact pushes the particle, (3,)). A contact between two faces or edges has a row for each of their corners that is
free to move.)")
      .def("forces", &forces, R"(forces(self)
--

The mean forces [N] of pins on their bodies and of attachments on their first ends, since the last begin of frame() or
reset_forces(), or since time 0: a structured array with the fields name (text) and force (3,). Forces on obstacles are not recorded. Raises
InputError unless the scene has "output": {"forces": true}, or the simulator was made with record_forces=True.)")
      .def("contact_forces", &contact_forces, R"(contact_forces(self)
--

The mean force [N] with which obstacles and bodies push each particle, with friction, since the last begin of frame() or
reset_forces(), or since time 0: a new array (n, 3), whose rows of a body are those of Body.slice. Raises InputError unless the
scene has "output": {"forces": true}, or the simulator was made with record_forces=True.)")
      .def(
          "reset_forces", [](ScriptedSimulator& self) { self.change([](Simulator& changed) { changed.reset_forces(); }); },
          "reset_forces(self)\n--\n\nBegin a new interval for forces() and contact_forces(). frame() does so too.")
      .def("add_force", &add_force, py::arg("function"), py::kw_only(), py::arg("body") = py::none(),
           R"(add_force(self, function, *, body=None)
--

Add an external force. Steps call function(x, v, t) with positions [m] and velocities [m/s] of all particles, or of one body,
as read-only copies (n, 3), and the time [s]; it returns forces [N], (n, 3). Body.slice has the rows of a body.

If it raises, the step raises the same exception, and the simulator is at the begin of the step. If it returns another shape, or a
number that is not finite, the step raises InputError. add_force() calls it too, and does not add it if it fails. It may not use
the simulator. Runge-Kutta calls it four times a step, and a repeated step calls it again, so it must depend on its arguments
alone.)")
      .def("remove_force", &remove_force, py::arg("function"), "remove_force(self, function)\n--\n\nRemove a force that was added.")
      .def("pin", &pin, py::arg("body"), py::arg("particles"), py::arg("name"), R"(pin(self, body, particles, name)
--

Fix particles of a body, a number or several, where they are, and return their pin. Particles that are pinned already stay with
their pin.)")
      .def("release", &release, py::arg("body"), py::arg("particles"), R"(release(self, body, particles)
--

Free particles of a body, a number or several, from their pin, with its velocity.)")
      .def("state", &state_of, "state(self)\n--\n\nThe present state, from which restore() continues bit by bit.")
      .def(
          "restore",
          [](ScriptedSimulator& self, const StateSnapshot& state) {
            self.change([&](Simulator& changed) { changed.restore(*state.checkpoint); });
          },
          py::arg("state"), R"(restore(self, state)
--

Continue from a state of this simulator, of a copy, or of another one of the same scene. Gravity and springs stay as they are
now. Views show the restored positions. Raises InputError if the state does not fit; nothing has changed then.)")
      .def("copy", &ScriptedSimulator::copy, R"(copy(self)
--

A simulator that continues as this one would, bit by bit. Both share the model and the added forces. It costs next to nothing: the
first of both that steps then pays for the copy, as much as a few dozen steps.)")
      .def("__copy__", &ScriptedSimulator::copy)
      .def(
          "__deepcopy__", [](ScriptedSimulator& self, const py::dict& /*memo*/) { return self.copy(); }, py::arg("memo"))
      .def("save", &save, py::arg("path"), R"(save(self, path)
--

Write a file from which sprung.restore(path) continues bit by bit: the state, the scene with its overrides, and changes of gravity
and springs. Meshes, added forces and the network of a NetworkBuilder are not in the file. Raises FileError; a former file then
stays.)")
      .def("load", &load_state, py::arg("path"), R"(load(self, path)
--

Continue from a saved simulator of the same scene or network. Raises FileError or InputError; nothing has changed then.)")
      .def("__reduce__",
           [](const py::object& /*self*/) -> py::object {
             throw py::type_error(
                 "a simulator cannot be pickled: save(path) it and call sprung.restore(path), or load its scene in each process");
           })
      .def("__repr__", &text_of);
  add_step(simulator);
  bind_batch(module);
}

}  // namespace sprung::python
