#include "network/bodies/triangle_bends.h"

#include "network/bodies/shape_parts.h"

#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace sprung {
namespace {

/// Squared weight of the average of normals, relative to that of the quadratic surface. With less, sheets with alternating or
/// crossing diagonals are too soft, as the surfaces of their triangles differ; with more, they are too stiff.
constexpr double kShareOfNormals = 0.3;

/// Triangles with a smaller height, relative to their longest side, are too thin to have a normal.
constexpr double kThin = 1e-6;

using Edge = std::pair<Index, Index>;

/// A side of a triangle: `corners` are its ends in the order of the triangle and the far corner.
struct Side {
  Index triangle = 0;
  std::size_t number = 0;
  std::array<Index, 3> corners{};
};

/// A symmetric 2 x 2 matrix as a vector whose product with itself is the sum of its squared entries (Mandel).
Vector3 square_of(const Eigen::Vector2d& v) { return {v.x() * v.x(), v.y() * v.y(), std::numbers::sqrt2 * v.x() * v.y()}; }

class BendBuilder {
 public:
  explicit BendBuilder(BodyShape& shape) : shape_(shape), triangles_(shape.surface.triangles) {}

  void add(const std::vector<const SpringMaterial*>& materials) {
    find_hinges();
    for (Index t = 0; t < triangles_.cols(); ++t) {
      if (hinges_of_[t] == kNoHinges) continue;
      const SpringMaterial& material = *materials[static_cast<std::size_t>(t)];
      FaceBends& bends = shape_.face_bends;
      bends.hinges.push_back(hinges_of_[t]);
      bends.curvature.push_back(curvature_of(t));
      bends.stiffness.push_back(material.value);
      bends.damping.push_back(damping_of(material, material.value));
    }
  }

 private:
  static constexpr std::array<Index, 3> kNoHinges{kNone, kNone, kNone};

  [[nodiscard]] const Vector3& at(Index particle) const { return shape_.positions[static_cast<std::size_t>(particle)]; }

  [[nodiscard]] Vector3 doubled_area(const std::array<Index, 3>& corners) const {
    return (at(corners[1]) - at(corners[0])).cross(at(corners[2]) - at(corners[0]));
  }

  [[nodiscard]] bool is_thin(const std::array<Index, 3>& corners) const {
    double longest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (at(corners[k]) - at(corners[(k + 1) % 3])).squaredNorm());
    return !(doubled_area(corners).norm() > kThin * longest);
  }

  void find_hinges() {
    std::map<Edge, std::vector<Side>> sides;
    for (Index t = 0; t < triangles_.cols(); ++t) {
      const std::array<Index, 3> corners{triangles_(0, t), triangles_(1, t), triangles_(2, t)};
      if (is_thin(corners)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Side side{t, k, {corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]}};
        sides[std::minmax(side.corners[0], side.corners[1])].push_back(side);
      }
    }
    hinges_of_.assign(static_cast<std::size_t>(triangles_.cols()), kNoHinges);
    for (const auto& [edge, faces] : sides) {
      if (faces.size() != 2 || faces[0].corners[2] == faces[1].corners[2]) continue;
      hinges_of_[faces[0].triangle][faces[0].number] = shape_.hinges.count();
      hinges_of_[faces[1].triangle][faces[1].number] = shape_.hinges.count();
      add_hinge(faces[0], faces[1]);
    }
  }

  void add_hinge(const Side& left, const Side& right) {
    const auto [a, b, c] = left.corners;
    const Index d = right.corners[2];
    const Vector3 edge = at(b) - at(a);
    const double length = edge.norm();
    // Whichever way round the triangles have their corners.
    const Vector3 left_normal = edge.cross(at(c) - at(a));
    const Vector3 right_normal = (at(d) - at(a)).cross(edge);
    const double left_height = left_normal.norm() / length;
    const double right_height = right_normal.norm() / length;
    const double left_foot = (at(c) - at(a)).dot(edge) / (length * length);
    const double right_foot = (at(d) - at(a)).dot(edge) / (length * length);
    Hinges& hinges = shape_.hinges;
    hinges.particles.push_back({a, b, c, d});
    hinges.rest_angle.push_back(std::atan2(right_normal.cross(left_normal).dot(edge) / length, left_normal.dot(right_normal)));
    hinges.rest_area.push_back({left_normal.norm() / 2.0, right_normal.norm() / 2.0});
    hinges.weights.push_back({-(1.0 - left_foot) / left_height - (1.0 - right_foot) / right_height,
                              -left_foot / left_height - right_foot / right_height, 1.0 / left_height, 1.0 / right_height});
  }

  /// See FaceBends::curvature.
  [[nodiscard]] Matrix3 curvature_of(Index triangle) const {
    const std::array<Index, 3> corners{triangles_(0, triangle), triangles_(1, triangle), triangles_(2, triangle)};
    const Vector3 normal = doubled_area(corners);
    const double area = normal.norm() / 2.0;
    Eigen::Matrix<double, 2, 3> axes;
    axes.row(0) = (at(corners[1]) - at(corners[0])).normalized();
    axes.row(1) = normal.normalized().cross(axes.row(0).transpose());
    Matrix3 angles = Matrix3::Zero();      // the angles of the hinges of z = 1/2 x^T C x, as products of the rows with C
    Matrix3 of_normals = Matrix3::Zero();  // C from the normals at the edges, as the sum of angles times columns
    Matrix3 of_borders = Matrix3::Zero();  // columns of edges without a hinge, whose angles are free
    for (std::size_t k = 0; k < 3; ++k) {
      const auto side = static_cast<Index>(k);
      const Eigen::Vector2d edge = axes * (at(corners[(k + 1) % 3]) - at(corners[k]));
      const Eigen::Vector2d outward = Eigen::Vector2d(edge.y(), -edge.x()).normalized();
      const Vector3 column = edge.norm() / (2.0 * area) * square_of(outward);
      const Index hinge = hinges_of_[triangle][k];
      if (hinge == kNone) {
        of_borders.col(side) = column;
        continue;
      }
      const std::array<Index, 4>& particles = shape_.hinges.particles[hinge];
      const bool is_left = particles[2] == corners[(k + 2) % 3];
      const bool same_order = particles[0] == corners[k];
      const double sign = is_left || !same_order ? 1.0 : -1.0;  // -1: the neighbour is turned over
      of_normals.col(side) = sign * column;
      angles.row(side) = sign * angle_of_curvature(hinge, same_order ? edge : -edge, is_left ? -outward : outward).transpose();
    }
    // The moment at a free edge is zero: its angle takes the value with the least energy.
    const Eigen::ColPivHouseholderQR<Matrix3> borders(of_borders);
    const auto free = borders.rank();
    const Matrix3 q = borders.householderQ();
    of_normals -= q.leftCols(free) * (q.leftCols(free).transpose() * of_normals);
    const double share = kShareOfNormals * angles.squaredNorm();
    const Matrix3 matrix = angles.transpose() * angles + share * Matrix3::Identity();
    return std::sqrt(area) * matrix.inverse() * (angles.transpose() + share * of_normals);
  }

  /// The angle of a hinge in the surface z = 1/2 x^T C x, as a product with C. `along` is the edge, `left` the direction of its
  /// left triangle in the plane.
  [[nodiscard]] Vector3 angle_of_curvature(Index hinge, const Eigen::Vector2d& along, const Eigen::Vector2d& left) const {
    const std::array<Index, 4>& particles = shape_.hinges.particles[hinge];
    const std::array<double, 4>& weights = shape_.hinges.weights[hinge];
    const Vector3 origin = at(particles[0]);
    const Vector3 edge = at(particles[1]) - origin;
    const auto foot = [&](Index corner) { return (at(corner) - origin).dot(edge) / edge.squaredNorm(); };
    return 0.5 * (weights[1] * square_of(along) + weights[2] * square_of(foot(particles[2]) * along + left / weights[2]) +
                  weights[3] * square_of(foot(particles[3]) * along - left / weights[3]));
  }

  BodyShape& shape_;
  const Triangles& triangles_;
  std::vector<std::array<Index, 3>> hinges_of_;  // by triangle and side
};

}  // namespace

void add_triangle_bends(const std::vector<const SpringMaterial*>& materials, BodyShape& shape) {
  BendBuilder(shape).add(materials);
}

}  // namespace sprung
