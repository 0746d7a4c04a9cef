#include "collision/mesh_shape.h"

#include "base/error.h"
#include "base/format.h"
#include "geometry/side_of_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {

namespace {

// Closest points are off by some tens of roundings of the largest coordinate that they are computed from.
constexpr double kRounding = 1e-14;

// Distances are first bounded in single precision, in which the square of a larger coordinate would not be finite.
constexpr double kLargestCoordinate = 1e15;

void require_usable(const TriangleMesh& mesh) {
  std::vector<Problem> problems;
  if (mesh.triangles.cols() == 0) problems.push_back({.key = "mesh", .rule = "must have triangles"});
  for (Index i = 0; i < mesh.vertices.cols(); ++i) {
    if ((mesh.vertices.col(i).array().abs() <= kLargestCoordinate).all()) continue;
    const bool finite = mesh.vertices.col(i).allFinite();
    problems.push_back(
        {.key = "mesh: vertex " + std::to_string(i),
         .rule = finite ? "must be within " + format_number(kLargestCoordinate) + " m of the origin" : "must be finite",
         .remedy = finite ? "use a smaller scale" : "import and clean the mesh"});
    break;  // the first stands for all
  }
  for (Index t = 0; t < mesh.triangles.cols(); ++t) {
    const auto corners = mesh.triangles.col(t);
    if (corners.minCoeff() >= 0 && corners.maxCoeff() < mesh.vertices.cols()) continue;
    problems.push_back({.key = "mesh: triangle " + std::to_string(t),
                        .rule = "must use vertices from 0 to " + std::to_string(mesh.vertices.cols() - 1),
                        .remedy = "import and clean the mesh"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace

MeshShape::MeshShape(const MeshGeometry& geometry) : mesh_(geometry.mesh), closed_(geometry.closed) {
  if (!mesh_) throw InputError(Problem{.key = "mesh", .rule = "must be given"});
  require_usable(*mesh_);
  bounds_ = sprung::bounds(mesh_->vertices);
  magnitude_ = mesh_->vertices.cwiseAbs().maxCoeff();
  tree_.emplace(*mesh_);
  pseudonormals_ = pseudonormals(*mesh_);
}

std::optional<SurfacePoint> MeshShape::nearest(const Vector3& p, double radius) const {
  const auto found = tree_->nearest(p, radius);
  if (!found) return std::nullopt;
  return surface_point(p, *found);
}

SurfacePoint MeshShape::surface_point(const Vector3& p, const MeshTree::Nearest& found) const {
  const auto& [triangle, closest] = found;
  const Vector3 away = p - closest.point;
  const double length = std::sqrt(closest.squared_distance);
  const auto corner = mesh_->triangles.col(triangle);
  const Points& x = mesh_->vertices;
  const double reach = std::max({x.col(corner[0]).cwiseAbs().maxCoeff(), x.col(corner[1]).cwiseAbs().maxCoeff(),
                                 x.col(corner[2]).cwiseAbs().maxCoeff(), p.cwiseAbs().maxCoeff()});

  // Above a face, and everywhere within rounding of the surface, the face's normal is better than the direction to the particle,
  // and the exact side better than that direction's.
  if (closest.feature == TriangleFeature::face || length <= kRounding * reach) {
    const Vector3 face = pseudonormals_.face.col(triangle);
    const bool back = side_of_plane(x.col(corner[0]), x.col(corner[1]), x.col(corner[2]), p) < 0.0;
    if (!closed_) return {closest.point, back ? Vector3(-face) : face, length};
    return {closest.point, face, back ? -length : length};
  }
  const bool inside = closed_ && pseudonormals_.at(mesh_->triangles, triangle, closest.feature).dot(away) < 0.0;
  return {closest.point, (inside ? -away : away) / length, inside ? -length : length};
}

std::optional<Crossing> MeshShape::first_crossing(const Vector3& a, const Vector3& b) const {
  const auto hit = tree_->first_hit(a, b, closed_ ? CrossingSides::front : CrossingSides::both);
  if (!hit) return std::nullopt;
  const Vector3 face = pseudonormals_.face.col(hit->triangle);
  return Crossing{hit->fraction, a + hit->fraction * (b - a), face.dot(b - a) > 0.0 ? Vector3(-face) : face};
}

bool MeshShape::contains(const Vector3& p) const {
  if (!closed_ || !bounds_.contains(p)) return false;
  const auto found = tree_->nearest(p, std::numeric_limits<double>::infinity());
  return surface_point(p, *found).distance < 0.0;
}

double MeshShape::rounding(const Vector3& p) const { return kRounding * (magnitude_ + p.cwiseAbs().maxCoeff()); }

}  // namespace sprung
