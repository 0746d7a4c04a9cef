#include "base/format.h"
#include "network/bodies/body_rules.h"
#include "network/bodies/body_shape.h"
#include "network/bodies/shape_parts.h"

#include <numeric>

namespace sprung {
namespace {

std::vector<double> segment_lengths(const std::vector<Vector3>& points) {
  std::vector<double> lengths;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) lengths.push_back((points[k + 1] - points[k]).norm());
  return lengths;
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

bool uses_modulus(const std::optional<SpringMaterial>& material) {
  return material && material->measure == SpringMaterial::Measure::modulus;
}

void check_points(const RopeShape& rope, ProblemList& problems) {
  bool finite = true;
  for (std::size_t k = 0; k < rope.points.size(); ++k) {
    if (rope.points[k].allFinite()) continue;
    problems.add(entry_key("points", k), vector_text(rope.points[k]), "must be finite", "give three numbers in m");
    finite = false;
  }
  if (rope.points.size() < 2) {
    problems.add("points", std::to_string(rope.points.size()) + " points", "must be at least 2", "give the two ends of the rope");
  } else if (finite) {
    problems.require_positive("points (length of the polyline)", sum(segment_lengths(rope.points)), "give two different ends");
  }
}

bool bends_by_angle(const SpringMaterials& materials) {
  return materials.bend && materials.bend_model == SpringMaterials::BendModel::angle;
}

// Without `particles` there is a particle at each point. Two at the same position would need an infinite stiffness, and a bond
// without length has no direction.
void check_lengths(const RopeShape& rope, const SpringMaterials& materials, ProblemList& problems) {
  if (rope.particles) return;
  if (!uses_modulus(materials.structural) && !uses_modulus(materials.bend) && !bends_by_angle(materials)) return;
  for (std::size_t k = 1; k < rope.points.size(); ++k) {
    if (rope.points[k] != rope.points[k - 1]) continue;
    problems.add(entry_key("points", k), vector_text(rope.points[k]),
                 "must differ from the previous point, because a modulus or an angle needs a segment with a length",
                 "leave the point out, or give `stiffness` and the model \"spring\"");
  }
}

void check(const RopeShape& rope, const SpringMaterials& materials) {
  ProblemList problems;
  check_points(rope, problems);
  if (rope.particles) problems.require_count("particles", *rope.particles, 2);
  const double particles = rope.particles ? *rope.particles : static_cast<double>(rope.points.size());
  require_affordable(rope.particles ? "particles" : "points", format_number(particles), particles, problems);
  if (rope.length)
    problems.require_positive("length", *rope.length, "give the rest length of the whole rope in m, or leave it out");
  check_lengths(rope, materials, problems);
  require_materials(materials, problems);
  problems.throw_if_any();
}

// Particles at equal distances along the polyline.
std::vector<Vector3> resample(const std::vector<Vector3>& points, const std::vector<double>& lengths, Index particles) {
  const double spacing = sum(lengths) / (particles - 1);
  std::vector<Vector3> positions{points.front()};
  std::size_t segment = 0;
  double begin = 0.0;
  for (Index i = 1; i + 1 < particles; ++i) {
    const double target = spacing * i;
    while (segment + 1 < lengths.size() && begin + lengths[segment] < target) begin += lengths[segment++];
    const double fraction = std::min(1.0, (target - begin) / lengths[segment]);
    positions.emplace_back(points[segment] + (points[segment + 1] - points[segment]) * fraction);
  }
  positions.push_back(points.back());
  return positions;
}

void add_springs(Springs& springs, const std::vector<double>& rest_lengths, const SpringMaterials& materials) {
  const auto add = [&](Index first, Index second, double rest, const std::optional<SpringMaterial>& material, SpringKind kind) {
    if (material) append_spring(springs, first, second, rest, *material, 1.0, kind);
  };
  const Index count = static_cast<Index>(rest_lengths.size());
  for (Index i = 0; i < count; ++i) add(i, i + 1, rest_lengths[i], materials.structural, SpringKind::structural);
  if (bends_by_angle(materials)) return;
  for (Index i = 0; i + 1 < count; ++i) add(i, i + 2, rest_lengths[i] + rest_lengths[i + 1], materials.bend, SpringKind::bend);
}

void add_angle_bends(AngleBends& bends, const std::vector<double>& rest_lengths, const SpringMaterials& materials) {
  if (!bends_by_angle(materials)) return;
  for (Index i = 0; i + 1 < static_cast<Index>(rest_lengths.size()); ++i) {
    const std::array<double, 2> lengths{rest_lengths[i], rest_lengths[i + 1]};
    const double stiffness = stiffness_of(*materials.bend, 1.0, (lengths[0] + lengths[1]) / 2.0);
    bends.append({i, i + 1, i + 2}, lengths, stiffness, damping_of(*materials.bend, stiffness));
  }
}

}  // namespace

BodyShape make_rope(const RopeShape& rope, const SpringMaterials& materials) {
  check(rope, materials);
  const std::vector<double> lengths = segment_lengths(rope.points);
  const double polyline_length = sum(lengths);
  const double length = rope.length.value_or(polyline_length);

  BodyShape shape = shape_of_particles(rope.particles ? resample(rope.points, lengths, *rope.particles) : rope.points, materials);
  const std::size_t segments = shape.positions.size() - 1;
  std::vector<double> rest_lengths(segments, length / static_cast<double>(segments));
  if (!rope.particles) {
    for (std::size_t k = 0; k < segments; ++k) rest_lengths[k] = rope.length ? lengths[k] * (length / polyline_length) : lengths[k];
  }
  add_springs(shape.springs, rest_lengths, materials);
  add_angle_bends(shape.angle_bends, rest_lengths, materials);

  shape.surface.segments.resize(2, static_cast<Eigen::Index>(segments));
  for (Eigen::Index k = 0; k < shape.surface.segments.cols(); ++k) {
    shape.surface.segments.col(k) << static_cast<Index>(k), static_cast<Index>(k) + 1;
  }
  shape.dimension = 1;
  shape.measure = length;
  shape.measures.assign(shape.positions.size(), 0.0);
  add_segment_measures(shape.surface.segments, rest_lengths, shape.measures);
  shape.drag_areas = shape.measures;
  return shape;
}

}  // namespace sprung
