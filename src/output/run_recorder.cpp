#include "output/run_recorder.h"

#include "network/model/activity.h"
#include "output/scene_extent.h"
#include "simulation/model.h"
#include "simulation/simulator.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace sprung {
namespace {

RecordedBody recorded(const Body& body, const ObjSources& sources, const BodyMaterials& materials) {
  RecordedBody result{.name = body.name,
                      .material = {},
                      .first_particle = body.first_particle,
                      .particle_count = body.particle_count,
                      .particle_of = std::vector<Index>(static_cast<std::size_t>(body.exported_vertex_count())),
                      .faces = body.surface.faces,
                      .lines = body.surface.segments};
  std::iota(result.particle_of.begin(), result.particle_of.end(), 0);
  if (const auto material = materials.find(body.name); material != materials.end()) result.material = material->second;
  if (const auto source = sources.find(body.name); source != sources.end()) {
    result.source = source->second;
    if (!source->second->particle_of.empty()) result.particle_of = source->second->particle_of;
    result.faces = source->second->faces;
    result.lines = source->second->lines;
    for (const auto& [name, first_face] : source->second->file.face_materials()) {
      result.face_materials.push_back(name);
      result.face_material_begin.push_back(first_face);
    }
  }
  for (Index& particle : result.particle_of) particle += body.first_particle;
  return result;
}

RecordedPin recorded(const Pin& pin) {
  return {.name = pin.name, .particles = pin.particles, .obstacle = pin.obstacle, .from = pin.from, .until = pin.until};
}

RecordedObstacle recorded(const Obstacle& obstacle, const Box3& scene) {
  const ObstacleMotion motion = motion_of(obstacle);
  TriangleMesh mesh = surface_mesh(obstacle, scene);
  if (motion == ObstacleMotion::fixed) mesh.vertices = obstacle.rest_pose * mesh.vertices;
  return {.name = obstacle.name, .motion = motion, .mesh = std::move(mesh)};
}

}  // namespace

ObstacleMotion motion_of(const Obstacle& obstacle) {
  if (obstacle.deforms()) return ObstacleMotion::deforming;
  return obstacle.changes() ? ObstacleMotion::rigid : ObstacleMotion::fixed;
}

RunRecorder::RunRecorder(const Simulator& simulator, const ObjSources& sources, const BodyMaterials& materials) {
  const SpringNetwork& network = simulator.model()->network();
  model_.particle_count = network.particle_count();
  for (const Body& body : network.bodies) model_.bodies.push_back(recorded(body, sources, materials));
  for (const Pin& pin : network.pins) model_.pins.push_back(recorded(pin));
  model_.attachments = network.attachments;
  const Box3 scene = scene_bounds(simulator);
  for (const Obstacle& obstacle : simulator.obstacles()) model_.obstacles.push_back(recorded(obstacle, scene));
  const Springs& springs = network.springs;
  model_.springs.ends.resize(Eigen::NoChange, springs.count());
  model_.springs.rest_lengths = springs.rest_length;
  model_.springs.kinds = springs.kind;
  model_.springs.stiffness = springs.stiffness;
  model_.springs.damping = springs.damping;
  for (Index s = 0; s < springs.count(); ++s) model_.springs.ends.col(s) << springs.first[s], springs.second[s];
}

RecordedFrame RunRecorder::frame(const Simulator& simulator) {
  const SpringNetwork& network = simulator.network();
  RecordedFrame frame{.time = simulator.time(),
                      .positions = simulator.positions(),
                      .velocities = simulator.state().v,
                      .states = std::vector<std::uint8_t>(static_cast<std::size_t>(network.particle_count())),
                      .broken = simulator.state().springs.broken};
  // Pins that are due begin and end at the begin of the next step, but count from their time on.
  const double due = due_before(whole_steps(simulator.state()), simulator.settings().step);
  for (const Pin& pin : network.pins) {
    if (!holds_at(pin, due)) continue;
    for (const Index particle : pin.particles) frame.states[particle] |= kPinned;
  }
  for (const Index particle : simulator.contact_particles()) frame.states[particle] |= kInContact;
  for (const Obstacle& obstacle : simulator.obstacles()) {
    frame.poses.push_back(obstacle.changes() ? obstacle.motion.pose(obstacle.rest_pose, simulator.time())
                                             : RigidTransform::Identity());
    if (obstacle.deforms()) frame.deformed.push_back(obstacle_mesh(obstacle.geometry, 0.0, simulator.time()).vertices);
  }
  return frame;
}

}  // namespace sprung
