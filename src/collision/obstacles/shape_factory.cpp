#include "collision/shapes/obstacle_shape.h"

#include "base/error.h"
#include "base/format.h"
#include "collision/primitives/primitive_shape.h"
#include "collision/shapes/mesh_shape.h"

#include <cmath>

namespace sprung {

namespace {

/// Collects the problems of a primitive's sizes.
class SizeCheck {
 public:
  void require_positive(const char* key, double value) {
    if (std::isfinite(value) && value > 0.0) return;
    problems_.push_back({.key = key, .value = format_number(value), .rule = "must be greater than 0 and finite"});
  }

  void require_positive(const char* key, const Vector3& value) {
    if (value.allFinite() && value.minCoeff() > 0.0) return;
    problems_.push_back({.key = key, .value = text(value), .rule = "must all be greater than 0 and finite"});
  }

  void require_unit(const char* key, const Vector3& value) {
    if (std::abs(value.norm() - 1.0) < 1e-9) return;
    problems_.push_back({.key = key, .value = text(value), .rule = "must have length 1"});
  }

  void require_finite(const char* key, double value) {
    if (std::isfinite(value)) return;
    problems_.push_back({.key = key, .value = format_number(value), .rule = "must be finite"});
  }

  void check(const SphereGeometry& sphere) { require_positive("radius", sphere.radius); }
  void check(const BoxGeometry& box) { require_positive("size", box.size); }
  void check(const CapsuleGeometry& capsule) {
    require_positive("radius", capsule.radius);
    require_positive("length", capsule.length);
  }
  void check(const CylinderGeometry& cylinder) {
    require_positive("radius", cylinder.radius);
    require_positive("height", cylinder.height);
  }
  void check(const ConeGeometry& cone) {
    require_positive("radius", cone.radius);
    require_positive("height", cone.height);
  }
  void check(const EllipsoidGeometry& ellipsoid) { require_positive("radii", ellipsoid.radii); }
  void check(const HalfSpaceGeometry& half_space) {
    require_unit("normal", half_space.normal);
    require_finite("offset", half_space.offset);
  }

  void throw_problems() const {
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  static std::string text(const Vector3& value) {
    std::string result;
    for (const double component : value) {
      result += result.empty() ? "[" : ", ";
      append_number(result, component);
    }
    return result + "]";
  }

  std::vector<Problem> problems_;
};

std::unique_ptr<ObstacleShape> make(const MeshGeometry& mesh) { return std::make_unique<MeshShape>(mesh); }
std::unique_ptr<ObstacleShape> make(const SequenceGeometry& sequence) { return std::make_unique<MeshShape>(sequence); }

template <class Geometry>
std::unique_ptr<ObstacleShape> make(const Geometry& geometry) {
  SizeCheck sizes;
  sizes.check(geometry);
  sizes.throw_problems();
  return std::make_unique<PrimitiveShape<Geometry>>(geometry);
}

}  // namespace

std::unique_ptr<ObstacleShape> make_shape(const ObstacleGeometry& geometry) {
  return std::visit([](const auto& of_kind) { return make(of_kind); }, geometry);
}

}  // namespace sprung
