#include "output/exporters/exported_shape.h"

#include <algorithm>
#include <limits>

namespace sprung {

std::vector<ExportedShape> shapes_of(const RecordedModel& model) {
  std::vector<ExportedShape> shapes;
  for (const RecordedBody& body : model.bodies) {
    ExportedShape& shape = shapes.emplace_back();
    shape.name = body.name;
    shape.body = static_cast<Index>(shapes.size()) - 1;
    shape.faces = body.faces;
    shape.lines = body.lines;
  }
  for (const RecordedObstacle& obstacle : model.obstacles) {
    ExportedShape& shape = shapes.emplace_back();
    shape.name = obstacle.name;
    shape.folder = "obstacles/";
    shape.obstacle = static_cast<Index>(&obstacle - model.obstacles.data());
    shape.changes = obstacle.motion != ObstacleMotion::fixed;
    shape.faces = to_polygons(obstacle.mesh.triangles);
  }
  return shapes;
}

Points vertices_of(const RecordedModel& model, const ExportedShape& shape, const RecordedFrame& frame) {
  if (shape.body != kNone) return vertices_of(model.bodies[shape.body], frame);
  const RecordedObstacle& obstacle = model.obstacles[shape.obstacle];
  if (obstacle.motion == ObstacleMotion::fixed) return obstacle.mesh.vertices;
  const RigidTransform& pose = frame.poses[shape.obstacle];
  if (obstacle.motion == ObstacleMotion::rigid) return pose * obstacle.mesh.vertices;
  const auto before = std::count_if(model.obstacles.begin(), model.obstacles.begin() + shape.obstacle,
                                    [](const RecordedObstacle& other) { return other.motion == ObstacleMotion::deforming; });
  return pose * frame.deformed[static_cast<std::size_t>(before)];
}

PolygonFaces faces_in(const ExportedShape& shape, const ExportedFrame& frame) {
  const bool tears = shape.body != kNone && static_cast<std::size_t>(shape.body) < frame.torn.size();
  return tears ? without_faces(shape.faces, frame.torn[shape.body]) : shape.faces;
}

bool has_materials(const RecordedModel& model) {
  return std::ranges::any_of(model.bodies, [](const RecordedBody& body) { return !body.face_materials.empty(); });
}

bool has_groups(const RecordedModel& model) {
  return std::ranges::any_of(model.bodies, [](const RecordedBody& body) { return body.faces.groups.size() > 1; });
}

VertexState vertex_state(const RecordedModel& model, const RecordedBody& body, const RecordedFrame& frame) {
  VertexState state;
  const auto count = static_cast<Eigen::Index>(body.particle_of.size());
  state.velocities =
      frame.velocities.cols() > 0 ? Points(frame.velocities(Eigen::all, body.particle_of)) : Points(Points::Zero(3, count));
  std::vector<float> of_particles(static_cast<std::size_t>(body.particle_count), -std::numeric_limits<float>::infinity());
  const RecordedSprings& springs = model.springs;
  for (std::size_t s = 0; s < springs.kinds.size(); ++s) {
    const bool is_broken = !frame.broken.empty() && frame.broken[s] != 0;
    if (springs.kinds[s] != SpringKind::structural || springs.rest_lengths[s] <= 0.0 || is_broken) continue;
    const auto ends = springs.ends.col(static_cast<Eigen::Index>(s));
    if (ends[0] < body.first_particle || ends[0] >= body.first_particle + body.particle_count) continue;
    const double length = (frame.positions.col(ends[0]) - frame.positions.col(ends[1])).norm();
    const auto stretch = static_cast<float>(length / springs.rest_lengths[s] - 1.0);
    for (const Index end : {ends[0], ends[1]}) {
      const Index particle = end - body.first_particle;
      if (particle >= 0 && particle < body.particle_count) of_particles[particle] = std::max(of_particles[particle], stretch);
    }
  }
  for (const Index particle : body.particle_of) {
    const float stretch = of_particles[particle - body.first_particle];
    state.stretch.push_back(stretch == -std::numeric_limits<float>::infinity() ? 0.0F : stretch);
    state.contact.push_back(frame.states.empty() ? 0 : frame.states[particle] & kInContact);
  }
  return state;
}

}  // namespace sprung
