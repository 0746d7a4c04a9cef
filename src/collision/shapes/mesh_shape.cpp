#include "collision/shapes/mesh_shape.h"

#include "base/error.h"
#include "base/format.h"
#include "base/problem_list.h"
#include "collision/mesh_bvh/mesh_bvh.h"
#include "collision/safe_regions/mesh_safe_region.h"
#include "geometry/queries/closest_pair.h"
#include "geometry/queries/side_of_plane.h"
#include "geometry/queries/simplex_crossing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace sprung {

namespace {

// A closest point has an error of a few tens of roundings of the largest coordinate.
constexpr double kRounding = 1e-14;

// A hit beyond this fraction of the segment to a surface point is on a triangle that shares the point.
constexpr double kBeforePoint = 1.0 - 1e-3;

// The search radius as a multiple of the requested radius. A search without a result then stays valid for longer motions.
constexpr double kSearchFactor = 2.0;

// Far above the relative rounding error of a sum of distances.
constexpr double kClearFraction = 1.0 - 0x1p-20;

// Intervals that a substep has at once: its own, its begin, and one of a subdivision.
constexpr std::size_t kMaxSpares = 3;

// With an invalid mesh FCL would crash or lose contacts silently.

// The search computes squared distances in single precision first. The square of a larger coordinate would not be finite.
constexpr double kLargestCoordinate = 1e15;

/// Adds a problem for the first invalid vertex only.
void check_vertices(const std::string& key, const Points& vertices, ProblemList& problems) {
  for (Index i = 0; i < vertices.cols(); ++i) {
    if ((vertices.col(i).array().abs() <= kLargestCoordinate).all()) continue;
    const bool finite = vertices.col(i).allFinite();
    problems.add(key + ": vertex " + std::to_string(i), "",
                 finite ? "must be within " + format_number(kLargestCoordinate) + " m of the origin" : "must be finite",
                 finite ? "use a smaller scale" : "import and clean the mesh");
    return;
  }
}

void check_triangles(const std::string& key, const Triangles& triangles, Eigen::Index vertices, ProblemList& problems) {
  if (triangles.cols() == 0) problems.add(key, "", "must have triangles", "");
  for (Index t = 0; t < triangles.cols(); ++t) {
    const auto corners = triangles.col(t);
    if (corners.minCoeff() >= 0 && corners.maxCoeff() < vertices) continue;
    problems.add(key + ": triangle " + std::to_string(t), "", "must use vertices from 0 to " + std::to_string(vertices - 1),
                 "import and clean the mesh");
  }
}

void require_usable(const TriangleMesh& mesh) {
  ProblemList problems;
  check_vertices("mesh", mesh.vertices, problems);
  check_triangles("mesh", mesh.triangles, mesh.vertices.cols(), problems);
  problems.throw_if_any();
}

void require_usable(const MeshSequence& sequence) {
  if (sequence.frames.empty()) throw InputError(Problem{.key = "sequence", .rule = "must have frames"});
  ProblemList problems;
  const Eigen::Index vertices = sequence.frames.front().cols();
  for (std::size_t k = 0; k < sequence.frames.size(); ++k) {
    const std::string key = "sequence: frame " + std::to_string(k);
    check_vertices(key, sequence.frames[k], problems);
    if (sequence.frames[k].cols() == vertices) continue;
    problems.add(key, std::to_string(sequence.frames[k].cols()) + " vertices",
                 "must have as many as the first frame, " + std::to_string(vertices), "");
  }
  check_triangles("sequence", sequence.triangles, vertices, problems);
  if (!(std::isfinite(sequence.frame_rate) && sequence.frame_rate > 0.0)) {
    problems.add("frame_rate", format_number(sequence.frame_rate), "must be greater than 0 and finite", "");
  }
  if (!std::isfinite(sequence.start)) {
    problems.add("start", format_number(sequence.start), "must be finite", "");
  }
  problems.throw_if_any();
}

double largest_coordinate(const Points& vertices) { return vertices.cwiseAbs().maxCoeff(); }

}  // namespace

/// Shapes of former intervals, whose memory new ones reuse: it is as large as the mesh, and a substep needs one or more.
struct MeshShape::Spares {
  std::unique_ptr<MeshShape> reuse() {
    const std::lock_guard lock(mutex);
    if (shapes.empty()) return nullptr;
    std::unique_ptr<MeshShape> last = std::move(shapes.back());
    shapes.pop_back();
    return last;
  }

  void add(std::unique_ptr<MeshShape> shape) {
    const std::lock_guard lock(mutex);
    if (shapes.size() < kMaxSpares) shapes.push_back(std::move(shape));
  }

  std::mutex mutex;
  std::vector<std::unique_ptr<MeshShape>> shapes;
};

MeshShape::MeshShape(const MeshGeometry& geometry) : rigid_(geometry.mesh), closed_(geometry.closed) {
  if (!rigid_) throw InputError(Problem{.key = "mesh", .rule = "must be given"});
  require_usable(*rigid_);
  magnitude_ = largest_coordinate(rigid_->vertices);
  tree_.emplace(*rigid_);
  bounds_ = tree_->bounds();
  pseudonormals_ = pseudonormals(*rigid_);
}

MeshShape::MeshShape(const SequenceGeometry& geometry) : closed_(geometry.closed) {
  if (!geometry.sequence) throw InputError(Problem{.key = "sequence", .rule = "must be given"});
  const MeshSequence& sequence = *geometry.sequence;
  require_usable(sequence);
  for (const Points& frame : sequence.frames) magnitude_ = std::max(magnitude_, largest_coordinate(frame));
  sequence_ = std::make_shared<const SequenceTree>(geometry.sequence);
  spares_ = std::make_shared<Spares>();
  deforms_ = sequence.deforms();
  fit_to(0.0, 0.0);
}

MeshShape::MeshShape(const MeshShape& shape, double begin, double end)
    : sequence_(shape.sequence_), deforms_(shape.deforms_), closed_(shape.closed_), magnitude_(shape.magnitude_) {
  fit_to(begin, end);
}

void MeshShape::fit_to(double begin, double end) {
  if (deforming_) deforming_->move_to(begin, end);
  if (!deforming_) deforming_.emplace(sequence_->mesh(begin, end));
  sequence_->fit(*deforming_, tree_);
  tree_before_ = tree_;
  tree_->set_positions(deforming_->after(), deforming_->triangles());
  tree_before_->set_positions(deforming_->before(), deforming_->triangles());
  bounds_ = tree_->bounds();
}

std::shared_ptr<const ObstacleShape> MeshShape::in_interval(double begin, double end) const {
  if (!deforms_) return nullptr;
  std::unique_ptr<MeshShape> shape = spares_ ? spares_->reuse() : nullptr;
  if (shape) shape->fit_to(begin, end);
  if (!shape) shape.reset(new MeshShape(*this, begin, end));
  return std::shared_ptr<MeshShape>(shape.release(), [spares = spares_](MeshShape* unused) {
    std::unique_ptr<MeshShape> spare(unused);
    if (spares) spares->add(std::move(spare));
  });
}

Vector3 MeshShape::displacement(const Vector3& p) const {
  if (!deforms_ || deforming_->largest_displacement() == 0.0) return Vector3::Zero();
  const auto [triangle, weights] = nearest_triangle_point(*tree_before_, p);
  return triangle == kNone ? Vector3(Vector3::Zero()) : deforming_->displacement(triangle, weights);
}

Vector3 MeshShape::displacement(const Vector3& p, double t, double t_end) const {
  if (!deforms_) return Vector3::Zero();
  const auto [triangle, weights] = nearest_triangle_point(*tree_, p);
  return triangle == kNone ? Vector3(Vector3::Zero()) : deforming_->displacement(triangle, weights, t, t_end);
}

std::optional<MovedElement> MeshShape::moved_element(const ElementCorners& element) const {
  if (!deforms_ || deforming_->largest_displacement() == 0.0) return {{element}};
  const SafeRegion region = nearest_before(element);
  if (region.broken || region.triangle == kNone) return std::nullopt;
  MovedElement result{element, region.distance};
  const SurfaceMotion motion = deforming_->motion(region.triangle, region.point);
  Vector3 nearest = Vector3::Zero();
  for (int i = 0; i < element.count; ++i) {
    Vector3& corner = result.corners.x[static_cast<std::size_t>(i)];
    corner = motion.after + motion.linear * (corner - region.point);
    nearest += region.weights[i] * corner;
  }
  const auto hit = tree_->first_hit(nearest, motion.after, CrossingSides::both);
  if (hit && hit->triangle != region.triangle && hit->fraction < kBeforePoint) return std::nullopt;
  return result;
}

// An element that the surface crosses in the interval is within twice the largest displacement of the surface.
SafeRegion MeshShape::nearest_before(const ElementCorners& element) const {
  SafeRegion region;
  if (element.count > 1) {
    const double reach = 2.0 * deforming_->largest_displacement();
    sprung::find_region(*tree_before_, element, {.reach = reach, .exact = reach}, region);
    return region;
  }
  const auto found = tree_before_->nearest(element.x[0], std::numeric_limits<double>::infinity());
  if (!found) return region;  // the particle is not finite
  region.triangle = found->triangle;
  region.point = found->closest.point;
  region.distance = std::sqrt(found->closest.squared_distance);
  region.normal = (element.x[0] - region.point).normalized();
  region.weights = Vector3::UnitX();
  return region;
}

std::optional<MovedTriangle> MeshShape::moved_triangle(const Vector3& p) const {
  if (!deforms_) return std::nullopt;
  const Index triangle = nearest_triangle_point(*tree_before_, p).triangle;
  if (triangle == kNone) return std::nullopt;
  return MovedTriangle{tree_before_->corners(triangle), tree_->corners(triangle)};
}

MeshShape::TrianglePoint MeshShape::nearest_triangle_point(const MeshBvh& tree, const Vector3& p) {
  const auto found = tree.nearest(p, std::numeric_limits<double>::infinity());
  if (!found) return {};  // p is not finite
  const auto [a, b, c] = tree.corners(found->triangle);
  return {found->triangle, barycentric(found->closest, a, b, c)};
}

std::optional<SurfacePoint> MeshShape::nearest(const Vector3& p, double radius) const {
  const auto found = tree_->nearest(p, radius);
  if (!found) return std::nullopt;
  return surface_point(p, *found);
}

std::optional<SurfacePoint> MeshShape::nearest_cached(const Vector3& p, double radius, double tolerance,
                                                      SurfaceMemory& memory) const {
  if (deforms_) return nearest(p, radius);
  const double moved = (p - memory.query_point).norm();
  if (moved + radius < kClearFraction * memory.clear) return std::nullopt;
  const auto if_within = [&](const MeshBvh::Nearest& found) {
    return found.closest.squared_distance < radius * radius ? std::optional(surface_point(p, found)) : std::nullopt;
  };
  const double farther = kSearchFactor * radius;
  std::optional<MeshBvh::Nearest> found;
  if (memory.triangle != kNone) {
    const auto corners = tree_->corners(memory.triangle);
    found = {memory.triangle, closest_point_on_triangle(p, corners[0], corners[1], corners[2]), corners};
    if (moved < tolerance) return if_within(*found);
    if (!(found->closest.squared_distance < farther * farther)) found.reset();
  }
  const auto nearer = tree_->nearest(p, found ? std::sqrt(found->closest.squared_distance) : farther);
  if (nearer) found = nearer;
  memory = {found ? found->triangle : kNone, p, found ? std::sqrt(found->closest.squared_distance) : farther};
  return found ? if_within(*found) : std::nullopt;
}

SurfacePoint MeshShape::surface_point(const Vector3& p, const MeshBvh::Nearest& found) const {
  const auto& [triangle, closest, corners] = found;
  const Vector3& a = corners[0];
  const Vector3& b = corners[1];
  const Vector3& c = corners[2];
  const Vector3 away = p - closest.point;
  const double length = std::sqrt(closest.squared_distance);
  const auto is_rounding = [&] {
    return length <= kRounding * a.cwiseAbs().cwiseMax(b.cwiseAbs()).cwiseMax(c.cwiseAbs()).cwiseMax(p.cwiseAbs()).maxCoeff();
  };

  // Above a face and within rounding of the surface, the face normal is more accurate than the direction to the particle, and the
  // side is decided exactly.
  if (closest.feature == TriangleFeature::face || is_rounding()) {
    const Vector3 face = face_normal(triangle);
    const bool back = side_of_plane(a, b, c, p) < 0.0;
    if (!closed_) return {closest.point, back ? Vector3(-face) : face, length};
    return {closest.point, face, back ? -length : length};
  }
  const bool inside = closed_ && pseudonormal(triangle, closest.feature).dot(away) < 0.0;
  return {closest.point, (inside ? -away : away) / length, inside ? -length : length};
}

std::optional<Crossing> MeshShape::first_crossing(const Vector3& a, const Vector3& b) const {
  const auto hit = tree_->first_hit(a, b, closed_ ? CrossingSides::front : CrossingSides::both);
  if (!hit) return std::nullopt;
  const Vector3 face = face_normal(hit->triangle);
  return Crossing{hit->fraction, a + hit->fraction * (b - a), face.dot(b - a) > 0.0 ? Vector3(-face) : face};
}

void MeshShape::find_region(const ElementCorners& element, const SafeRegionRequest& request, SafeRegion& region) const {
  const MeshBvh& tree = deforms_ && !request.at_end ? *tree_before_ : *tree_;
  sprung::find_region(tree, element, request, region);
  if (!deforms_) return;
  region.time = deforming_->end();
  if (region.triangle != kNone) set_triangle_weights(tree, region);
  if (!request.at_end) move_with_surface(region);
}

void MeshShape::set_triangle_weights(const MeshBvh& tree, SafeRegion& region) {
  const auto [a, b, c] = tree.corners(region.triangle);
  region.triangle_weights = barycentric(closest_point_on_triangle(region.point, a, b, c), a, b, c);
}

void MeshShape::update_closest_points(const ElementCorners& element, const SafeRegionRequest& request, bool fresh,
                                      SafeRegion& region) const {
  const MeshBvh& tree = deforms_ ? *tree_before_ : *tree_;
  ClosestFeatures last{region.triangle, region.features};
  if (!fresh) last = sprung::closest_features(tree, element, request, last);
  if (last.triangle == kNone) return;
  const ClosestPair pair = closest_pair(element, tree.corners(last.triangle), 0.0, 0.0, last.features);
  const Vector3 between = pair.on_simplex - pair.on_triangle;
  if (!(between.squaredNorm() > 0.0)) return;
  region.point = pair.on_triangle;
  region.normal = between.normalized();
  region.weights = pair.weights;
  region.triangle = last.triangle;
  region.features = pair.features;
  if (!deforms_) return;
  set_triangle_weights(tree, region);
  region.drift = deforming_->displacement(region.triangle, region.triangle_weights);
  region.point += region.drift;
}

bool MeshShape::advance_region(SafeRegion& region) const {
  if (!deforms_ || region.time == deforming_->end()) return true;
  if (region.time != deforming_->begin()) return false;
  region.time = deforming_->end();
  move_with_surface(region);
  return true;
}

void MeshShape::move_with_surface(SafeRegion& region) const {
  region.drift.setZero();
  if (region.broken || deforming_->largest_displacement() == 0.0) return;
  if (region.triangle != kNone) region.drift = deforming_->displacement(region.triangle, region.triangle_weights);
  shift(region, *tree_before_, *tree_);
}

bool MeshShape::touches(const ElementCorners& element, double tolerance) const {
  std::vector<Index> near;
  find_in_box(*tree_, box_around(element, tolerance), near);
  return std::any_of(near.begin(), near.end(), [&](Index t) {
    const auto triangle = tree_->corners(t);
    return intersects(element, triangle) || closest_pair(element, triangle).squared_distance <= tolerance * tolerance;
  });
}

bool MeshShape::contains(const Vector3& p) const { return closed_ && bounds_.contains(p) && winding_number(*tree_, p) > 0; }

double MeshShape::rounding(const Vector3& p) const { return kRounding * (magnitude_ + p.cwiseAbs().maxCoeff()); }

Vector3 MeshShape::face_normal(Index triangle) const {
  return deforming_ ? deforming_->face_normal(triangle) : Vector3(pseudonormals_.face.col(triangle));
}

Vector3 MeshShape::pseudonormal(Index triangle, TriangleFeature feature) const {
  return deforming_ ? deforming_->normal_at(triangle, feature) : pseudonormals_.at(rigid_->triangles, triangle, feature);
}

}  // namespace sprung
