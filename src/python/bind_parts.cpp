#include "base/format.h"
#include "python/bindings.h"
#include "python/parts.h"
#include "python/simulator/arrays.h"
#include "python/simulator/changes.h"
#include "python/simulator/errors.h"
#include "simulation/model.h"
#include "simulation/tension.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace py = pybind11;

namespace sprung::python {
namespace {

py::object read_only(const py::dict& parts) { return py::module_::import("types").attr("MappingProxyType")(parts); }

const Body& body_of(const BodyPart& part) { return part.simulator->peek().network().bodies[part.number]; }

// Arrays that the program writes. The addresses last, as the network keeps its particles.

py::array view(const BodyPart& part, Points& points) {
  const Body& body = body_of(part);
  return view_of(points.col(body.first_particle).data(), body.particle_count, py::cast(part.simulator));
}
py::array particles(const BodyPart& part) { return view(part, part.simulator->positions()); }
py::array velocities(const BodyPart& part) { return view(part, part.simulator->velocities()); }

/// `body.particles += by` assigns the array to itself.
void write(const BodyPart& part, Points& points, const std::string& what, const py::object& value) {
  const Body& body = body_of(part);
  points.middleCols(body.first_particle, body.particle_count) =
      points_of(value, "bodies." + body.name + "." + what, body.particle_count);
}

// Frames.

const ObjSource* source_of(const BodyPart& part) {
  const auto& origin = part.simulator->origin();
  if (!origin) return nullptr;
  const auto found = origin->bodies.find(body_of(part).name);
  return found == origin->bodies.end() || found->second->particle_of.empty() ? nullptr : found->second.get();
}

/// The particle of each vertex of the body's frames, in the numbering of the body.
std::vector<Index> particles_of_vertices(const BodyPart& part) {
  if (const ObjSource* source = source_of(part)) return source->particle_of;
  std::vector<Index> particles(static_cast<std::size_t>(body_of(part).exported_vertex_count()));
  for (std::size_t i = 0; i < particles.size(); ++i) particles[i] = static_cast<Index>(i);
  return particles;
}

py::array vertices(const BodyPart& part) {
  const Points& x = part.simulator->read().positions();
  const std::vector<Index> particles = particles_of_vertices(part);
  const Body& body = body_of(part);
  return copy_of(Points(x.middleCols(body.first_particle, body.particle_count)(Eigen::all, particles)));
}

py::array faces(const BodyPart& part) {
  const Body& body = body_of(part);
  const PolygonFaces left = without_faces(body.surface.faces, body.surface.torn);
  return copy_of(Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic>(triangulate(left)));
}

// Springs.

SpringTable springs(const BodyPart& part) {
  const SpringNetwork& network = part.simulator->peek().network();
  const Body& body = network.bodies[part.number];
  const Springs& all = network.springs;
  const auto begin = static_cast<std::size_t>(body.first_spring);
  const auto count = static_cast<std::size_t>(body.spring_count);
  Edges ends(2, body.spring_count);
  std::vector<std::string> names(kSpringKindNames.begin(), kSpringKindNames.end());
  std::vector<Index> kinds;
  for (std::size_t s = 0; s < count; ++s) {
    ends.col(static_cast<Eigen::Index>(s)) << all.first[begin + s] - body.first_particle,
        all.second[begin + s] - body.first_particle;
    kinds.push_back(static_cast<Index>(all.kind[begin + s]));
  }
  const auto part_of = [&](const std::vector<double>& numbers) { return copy_of(std::span(numbers).subspan(begin, count)); };
  return {.indices = copy_of(Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic>(ends)),
          .rest_lengths = part_of(all.rest_length),
          .stiffness = part_of(all.stiffness),
          .damping = part_of(all.damping),
          .kinds = names_of(names, kinds)};
}

py::array stretch(const BodyPart& part) {
  const Simulator& simulator = part.simulator->read();
  const Body& body = simulator.network().bodies[part.number];
  const Springs& all = simulator.network().springs;
  std::vector<double> stretches;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    const double length = (simulator.positions().col(all.first[s]) - simulator.positions().col(all.second[s])).norm();
    stretches.push_back(all.rest_length[s] > 0.0 ? length / all.rest_length[s] - 1.0 : 0.0);
  }
  return copy_of(std::span<const double>(stretches));
}

py::array tension(const BodyPart& part) {
  const Simulator& simulator = part.simulator->read();
  const Body& body = simulator.network().bodies[part.number];
  const Scalars all = spring_tensions(simulator);
  return copy_of(std::span(all.data() + body.first_spring, static_cast<std::size_t>(body.spring_count)));
}

/// The same part of a copy of its simulator. A structure that is copied as a whole gets one copy of each simulator.
template <class Part>
Part deep_copy(const Part& part, const py::dict& memo) {
  return {py::module_::import("copy").attr("deepcopy")(part.simulator, memo).template cast<Shared>(), part.number};
}

// Pins.

const Pin& pin_of(const PinPart& part) { return part.simulator->peek().network().pins[part.number]; }

void move_pin(const PinPart& part, const py::object& target, const py::object& rotation) {
  const std::string key = "pins." + pin_of(part).name + ".pose";
  RigidTransform pose = part.simulator->peek().pin_pose(part.number);
  if (is_matrix(target, key)) {
    if (!rotation.is_none()) refuse(key, "", "has a rotation already", "give a position and a rotation, or a (4, 4) pose");
    pose = pose_of(target, key);
  } else {
    pose.translation() = vector_of(target, key);
    if (!rotation.is_none()) pose.linear() = rotation_from_degrees(vector_of(rotation, key));
  }
  part.simulator->change([&](Simulator& simulator) { simulator.move_pin(part.number, pose); });
}

const Obstacle& obstacle_of(const ObstaclePart& part) { return part.simulator->peek().obstacles()[part.number]; }

void move_obstacle(const ObstaclePart& part, const py::object& target) {
  const std::string key = "obstacles." + obstacle_of(part).name + ".pose";
  const RigidTransform pose = pose_of(target, key);
  part.simulator->change([&](Simulator& simulator) { simulator.move_obstacle(part.number, pose); });
}

}  // namespace

py::object bodies_of(const Shared& simulator) {
  py::dict parts;
  const std::vector<Body>& bodies = simulator->peek().network().bodies;
  for (std::size_t k = 0; k < bodies.size(); ++k) parts[py::str(bodies[k].name)] = BodyPart{simulator, k};
  return read_only(parts);
}

py::object pins_of(const Shared& simulator) {
  py::dict parts;
  const std::vector<Pin>& pins = simulator->peek().network().pins;
  for (std::size_t k = 0; k < pins.size(); ++k) parts[py::str(pins[k].name)] = PinPart{simulator, k};
  return read_only(parts);
}

py::object obstacles_of(const Shared& simulator) {
  py::dict parts;
  const std::vector<Obstacle>& obstacles = simulator->peek().obstacles();
  for (std::size_t k = 0; k < obstacles.size(); ++k) parts[py::str(obstacles[k].name)] = ObstaclePart{simulator, k};
  return read_only(parts);
}

void bind_parts(py::module_& module) {
  py::class_<SpringTable>(module, "Springs", R"(The springs of a body, m of them, as read-only arrays in one order.

Springs that broke are left out.)")
      .def_readonly("indices", &SpringTable::indices, "Particles at the ends, numbered within the body: (m, 2) int32.")
      .def_readonly("rest_lengths", &SpringTable::rest_lengths, "Lengths at rest [m], (m,).")
      .def_readonly("stiffness", &SpringTable::stiffness, "k_s [N/m], (m,).")
      .def_readonly("damping", &SpringTable::damping, "k_d [N s/m], (m,).")
      .def_readonly("kinds", &SpringTable::kinds, "structural, shear or bend, (m,) texts.")
      .def("__len__", [](const SpringTable& table) { return table.indices.shape(0); });

  py::class_<BodyPart>(module, "Body", "A body of a simulator: n particles, m springs.")
      .def_property_readonly(
          "name", [](const BodyPart& part) { return body_of(part).name; }, "The name in the scene.")
      .def("__len__", [](const BodyPart& part) { return body_of(part).particle_count; })
      .def("__deepcopy__", &deep_copy<BodyPart>, py::arg("memo"))
      .def("__repr__",
           [](const BodyPart& part) {
             const Body& body = body_of(part);
             return "<sprung.Body \"" + body.name + "\": " + counted(static_cast<std::size_t>(body.particle_count), "particle") +
                    ", " + counted(static_cast<std::size_t>(body.spring_count), "spring") + ">";
           })
      .def_property(
          "particles", &particles,
          [](const BodyPart& part, const py::object& value) { write(part, part.simulator->positions(), "particles", value); },
          R"(Positions [m]: a writable view, (n, 3) float64.

It keeps the simulator alive and shows the present positions, also after springs broke, particles slept or steps were repeated.
The next call that uses the simulator checks what was written. It raises InputError, and the positions and velocities are
those before, if a number is not finite, if a pinned particle moved, or if a particle passed through an obstacle or a body
intersects something. The paths of particles are checked, but not those of edges and faces between them: an obstacle that is
thinner than the distance of two particles may pass between these. Do not write it from another thread during a step.)")
      .def_property(
          "velocities", &velocities,
          [](const BodyPart& part, const py::object& value) { write(part, part.simulator->velocities(), "velocities", value); },
          R"(Velocities [m/s]: a writable view, (n, 3) float64, as particles.

Pinned particles keep the velocities of their pins, whatever is written.)")
      .def_property_readonly(
          "masses",
          [](const BodyPart& part) {
            const Body& body = body_of(part);
            const Scalars& masses = part.simulator->peek().network().masses;
            return copy_of(std::span(masses.data() + body.first_particle, static_cast<std::size_t>(body.particle_count)));
          },
          "Masses [kg], (n,), read-only.")
      .def_property_readonly(
          "slice",
          [](const BodyPart& part) {
            const Body& body = body_of(part);
            return py::slice(body.first_particle, body.first_particle + body.particle_count, 1);
          },
          "The rows of the body in arrays of all particles, such as those that an added force gets.")
      .def_property_readonly("vertices", &vertices,
                             R"(Vertices of the body's frames [m], (k, 3), a read-only copy.

Of ropes, cloths and solids they are the particles. Of a mesh that is carried by a lattice they are the mesh's vertices, of
a welded one those of its file.)")
      .def_property_readonly(
          "vertex_particles", [](const BodyPart& part) { return copy_of(std::span<const Index>(particles_of_vertices(part))); },
          "The particle of each vertex, numbered within the body: (k,) int32, read-only.")
      .def_property_readonly("faces", &faces,
                             R"(Triangles of the surface as particles, numbered within the body: (f, 3) int32, a read-only copy.

Polygons are cut into fans, and torn faces are left out. Ropes have none.)")
      .def_property_readonly("springs", &springs, "The springs at present: indices, rest lengths, stiffness, damping, kinds.")
      .def_property_readonly("stretch", &stretch, "(length - rest length) / rest length of each spring, (m,), read-only.")
      .def_property_readonly("tension", &tension,
                             R"(Tension [N] of each spring, (m,), read-only; negative: it pushes.

The pull of a stretch limit is included if forces are recorded, see Simulator.forces.)")
      .def(
          "set_springs",
          [](const BodyPart& part, const py::object& stiffness, const py::object& damping, const py::object& kind) {
            set_springs(part.simulator, body_of(part).name, stiffness, damping, kind);
          },
          py::kw_only(), py::arg("stiffness") = py::none(), py::arg("damping") = py::none(), py::arg("kind") = py::none(),
          R"(set_springs(self, *, stiffness=None, damping=None, kind=None)
--

Give springs another stiffness [N/m] and damping [N s/m]: a number for all, or an array (m,) in the order of springs. None keeps
what is. kind: structural, shear or bend; None: all. The simulator gets a model of its own, and goes on; copies keep theirs.
Raises InputError if the step is too large for the new springs.)");

  py::class_<PinPart>(module, "Pin", "A pin of a simulator, which holds particles or moves them.")
      .def("__deepcopy__", &deep_copy<PinPart>, py::arg("memo"))
      .def("__repr__",
           [](const PinPart& part) {
             return "<sprung.Pin \"" + pin_of(part).name + "\": " + counted(pin_of(part).particles.size(), "particle") + ">";
           })
      .def_property_readonly(
          "name", [](const PinPart& part) { return pin_of(part).name; }, "The name in the scene.")
      .def_property_readonly(
          "particles", [](const PinPart& part) { return copy_of(std::span<const Index>(pin_of(part).particles)); },
          "The particles, in the numbering of all bodies: (n,) int32, read-only.")
      .def_property_readonly(
          "pose", [](const PinPart& part) { return matrix_of(part.simulator->peek().pin_pose(part.number)); },
          "The pose now: rotation and translation [m], (4, 4), read-only.")
      .def_property_readonly(
          "position",
          [](const PinPart& part) {
            return py::array(copy_of(Points(part.simulator->peek().pin_pose(part.number).translation()))[py::int_(0)]);
          },
          "The position now [m], (3,), read-only.")
      .def("move_to", &move_pin, py::arg("target"), py::arg("rotation") = py::none(),
           R"(move_to(self, target, rotation=None)
--

Move the pin in the next step to a position [m], (3,), with a rotation [degrees] about the fixed axes x, y, z, (3,); None: as
now. Or to a pose, (4, 4). The particles follow the rigid motion, on a line, and the pin then stays there until it is moved again.
Raises InputError if the pin holds nothing, follows an obstacle, or would move farther in one step than the largest body is
large.)");

  py::class_<ObstaclePart>(module, "Obstacle", "An obstacle of a simulator.")
      .def("__deepcopy__", &deep_copy<ObstaclePart>, py::arg("memo"))
      .def("__repr__", [](const ObstaclePart& part) { return "<sprung.Obstacle \"" + obstacle_of(part).name + "\">"; })
      .def_property_readonly(
          "name", [](const ObstaclePart& part) { return obstacle_of(part).name; }, "The name in the scene.")
      .def_property(
          "pose", [](const ObstaclePart& part) { return matrix_of(part.simulator->peek().obstacle_pose(part.number)); },
          &move_obstacle,
          R"(The pose: rotation and translation [m], (4, 4).

Read it: the pose now, a copy. Assign it: the next step moves the obstacle there, on a line and with the shortest rotation, and
it then stays until it is moved again. Raises InputError if it is no rotation and translation, or farther away than the
largest body is large.)");
}

}  // namespace sprung::python
