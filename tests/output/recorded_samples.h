// A recorded model that has one of everything, and frames of it.
#pragma once

#include "output/record/recorded_model.h"

#include <memory>
#include <string_view>

namespace sprung::testing {

/// A quad with UVs whose last two vertices are one particle, a rope that a spring and a rod hold, and an obstacle of each motion.
inline RecordedModel model_with_one_of_each() {
  RecordedModel model{.particle_count = 6, .bodies = {}, .springs = {}, .pins = {}, .attachments = {}, .obstacles = {}};
  RecordedBody quad{.name = "quad",
                    .material = "silk",
                    .first_particle = 0,
                    .particle_count = 3,
                    .particle_of = {0, 1, 2, 2},
                    .faces = {},
                    .face_materials = {"red paint", "blue"},
                    .face_material_begin = {0, 1}};
  quad.faces.corner_begin = {0, 3, 6};
  quad.faces.vertex = {0, 1, 2, 1, 3, 2};
  quad.faces.texcoord = {0, 1, kNone, kNone, 1, 0};
  quad.faces.texcoords = {{0.1, 0.2}, {1.0 / 3.0, -4.0}};
  quad.faces.groups = {"left", "right"};
  quad.faces.group_begin = {0, 1};
  constexpr std::string_view kText =
      "mtllib look/a.mtl\nv 0 0 0\nv 1 0 0 red\nv 0 1 0\nv 0 1 0\nvt .1 .2\nusemtl red paint\nf 1/1 2/1 3\nusemtl blue\nf 2 4/1 "
      "3/1\n";
  quad.source = std::make_shared<ObjSource>(ObjSource{
      .file = ObjTemplate(kText, ObjTemplate::Normals::per_vertex),
      .particle_of = {0, 1, 2, 2},
      .materials = {.files = {{.place = "look/a.mtl", .text = "newmtl blue\n"}, {.place = "look/red.png", .is_texture = true}},
                    .missing = {},
                    .unusual = {},
                    .outside = {}},
      .faces = quad.faces});
  RecordedBody rope{.name = "rope", .first_particle = 3, .particle_count = 3, .particle_of = {3, 4, 5}, .faces = {}};
  rope.lines.resize(2, 2);
  rope.lines << 0, 1, 1, 2;
  model.bodies = {quad, rope};
  model.springs.ends.resize(2, 3);
  model.springs.ends << 0, 3, 4, 1, 4, 5;
  model.springs.rest_lengths = {1.0 / 3.0, 0.1, 0.0};
  model.springs.kinds = {SpringKind::structural, SpringKind::shear, SpringKind::bend};
  model.pins = {{.name = "quad.pins[0]", .particles = {0, 2}},
                {.name = "hook", .particles = {5}, .obstacle = 1, .from = 0.5, .until = 2.0}};
  model.attachments = {{.name = "attachments[0]", .particles = {3}, .second = ParticleEnds{{0, 1}}, .stiffness = 12.5},
                       {.name = "rod", .particles = {4, 5}, .second = ObstacleEnd{2}, .break_force = 9.0, .until = 1.0},
                       {.name = "sewn", .particles = {3}, .second = SurfaceEnd{0}, .rest_length = 0.25}};
  TriangleMesh triangle{Points(3, 3), Triangles(3, 1)};
  triangle.vertices << 0, 1, 0, 0, 0, 1, 0.1, 0.2, 0.3;
  triangle.triangles << 0, 1, 2;
  model.obstacles = {{.name = "floor", .motion = ObstacleMotion::fixed, .mesh = triangle},
                     {.name = "arm", .motion = ObstacleMotion::rigid, .mesh = triangle},
                     {.name = "heart", .motion = ObstacleMotion::deforming, .mesh = triangle}};
  return model;
}

/// Random positions and velocities; the spring of the rope breaks in frame 2.
inline RecordedFrame frame_of(const RecordedModel& model, int number) {
  RecordedFrame frame{.time = number / 3.0,
                      .positions = Points::Random(3, model.particle_count),
                      .velocities = Points::Random(3, model.particle_count),
                      .states = {0, kPinned, kInContact, kInContact | kPinned, 0, 0},
                      .broken = {0, static_cast<char>(number > 1), 0},
                      .poses = std::vector<RigidTransform>(3, RigidTransform::Identity()),
                      .deformed = {Points::Random(3, 3)}};
  frame.poses[1].translation() << 0.1, 0.2, number;
  frame.poses[1].linear() = Eigen::AngleAxisd(0.3, Vector3::UnitY()).toRotationMatrix();
  return frame;
}

}  // namespace sprung::testing
