#include "simulation/start/push_out.h"

#include "collision/mesh_bvh/mesh_bvh.h"
#include "collision/obstacles/obstacle_intersections.h"
#include "collision/surface/self_intersections.h"
#include "collision/surface/surface_topology.h"
#include "geometry/import/mesh_orientation.h"
#include "geometry/mesh/pseudonormal.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sprung {

namespace {

// Particles nearer than these distances are lifted, in element sizes; the first that succeeds is used. Two bodies that cross deeper
// are not layers.
constexpr std::array kReaches{1.0, 2.0, 4.0, 8.0};

// Heights beyond the gap, in element sizes: where particles are at their gap, faces may still cut the corners of the other body.
constexpr std::array kTrialHeights{0.25, 0.5, 1.0};

// Lifting fails if it makes an edge longer or shorter by this factor. The bodies then cross so steeply that what is beyond the
// surface would be pressed flat.
constexpr double kMaxDistortion = 2.0;

/// The triangles with area, those of each component wound alike.
TriangleMesh surface_mesh(const Body& body, const Points& positions) {
  TriangleMesh mesh{.vertices = positions.middleCols(body.first_particle, body.particle_count),
                    .triangles = Triangles(3, body.surface.triangles.cols())};
  Index kept = 0;
  for (const auto& corners : body.surface.triangles.colwise()) {
    mesh.triangles.col(kept) = corners;
    if (area_normal(mesh, kept).norm() > 0.0) ++kept;
  }
  mesh.triangles.conservativeResize(3, kept);
  orient_faces(mesh);
  return mesh;
}

/// The surface of a body at fixed positions.
class Layer {
 public:
  Layer(const Body& body, const Points& positions) : mesh_(surface_mesh(body, positions)) {
    if (mesh_.triangles.cols() == 0) return;
    tree_.emplace(mesh_);
    normals_ = pseudonormals(mesh_);
  }

  /// `x` [m] with the `particles` nearer than `reach` [m] lifted to `height` [m] or more along the pseudonormals, or, with `side`
  /// -1, against them. Pseudonormals tell the side of a particle in the surface too, and beyond its border.
  [[nodiscard]] Points lifted(const Points& x, const std::vector<Index>& particles, double side, double reach,
                              double height) const {
    Points result = x;
    if (!tree_) return result;
    for (const Index i : particles) {
      const auto nearest = tree_->nearest(x.col(i), reach);
      if (!nearest) continue;
      const Vector3 normal = side * normals_.at(mesh_.triangles, nearest->triangle, nearest->closest.feature).normalized();
      const double present = normal.dot(x.col(i) - nearest->closest.point);
      if (present < height) result.col(i) += (height - present) * normal;
    }
    return result;
  }

 private:
  TriangleMesh mesh_;
  std::optional<MeshBvh> tree_;  ///< none without triangles
  Pseudonormals normals_;
};

BodyPair pair_of(Index a, Index b) { return std::minmax(a, b); }

class Lift {
 public:
  Lift(const SpringNetwork& network, const CollisionSurface& surface, Index body, const Points& wanted)
      : network_(network), surface_(surface), body_(body), wanted_(wanted) {
    for (Index i = own().first_particle; i < own().first_particle + own().particle_count; ++i) {
      if (!network.is_pinned(i)) particles_.push_back(i);
    }
    for (const Element& element : surface.elements) {
      if (element.body == body) elements_.push_back(element);
    }
  }

  /// Lifts the body off another one, from `x`.
  [[nodiscard]] std::optional<Points> off(Index other, const Points& x) const {
    const Body& below = network_.bodies[static_cast<std::size_t>(other)];
    const Layer layer(below, x);
    const double size = surface_.element_size[static_cast<std::size_t>(body_)];
    const double gap = 0.5 * (own().material.thickness + below.material.thickness);
    for (const double reach : kReaches) {
      for (const double beyond : kTrialHeights) {
        std::optional<Points> best;
        double least = std::numeric_limits<double>::infinity();
        for (const double side : {1.0, -1.0}) {
          const Points lifted = layer.lifted(x, particles_, side, reach * size, gap + beyond * size);
          const double distance = (lifted - x).colwise().norm().maxCoeff();
          if (distance >= least || is_distorted(lifted)) continue;
          if (crossing_bodies(surface_, lifted).contains(pair_of(body_, other))) continue;
          best = lifted;
          least = distance;
        }
        if (best) return best;
      }
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] const Body& own() const { return network_.bodies[static_cast<std::size_t>(body_)]; }

  [[nodiscard]] bool is_distorted(const Points& x) const {
    return std::any_of(elements_.begin(), elements_.end(), [&](const Element& element) {
      for (int edge = 0; edge < edges_of(element); ++edge) {
        const auto [a, b] = ends_of(element, edge);
        const double before = (wanted_.col(a) - wanted_.col(b)).norm();
        const double after = (x.col(a) - x.col(b)).norm();
        if (after > kMaxDistortion * before || before > kMaxDistortion * after) return true;
      }
      return false;
    });
  }

  const SpringNetwork& network_;
  const CollisionSurface& surface_;
  Index body_;
  const Points& wanted_;
  std::vector<Index> particles_;   ///< that may move
  std::vector<Element> elements_;  ///< of the body
};

}  // namespace

std::set<BodyPair> crossing_bodies(const CollisionSurface& surface, const Points& positions) {
  const auto body_of = [&](Index element) { return surface.elements[static_cast<std::size_t>(element)].body; };
  std::set<BodyPair> pairs;
  for (const auto& [first, second] : find_self_intersections(surface, positions)) {
    pairs.insert(pair_of(body_of(first), body_of(second)));
  }
  return pairs;
}

std::optional<Points> lifted_off(const SpringNetwork& network, const ObstacleFrame& obstacles, const CollisionSurface& surface,
                                 Index body, const std::vector<Index>& below, const Points& wanted) {
  const Lift lift(network, surface, body, wanted);
  Points lifted = wanted;
  // Lifting off one body may press into another one.
  for (std::size_t round = 0; round <= below.size(); ++round) {
    const std::set<BodyPair> crossing = crossing_bodies(surface, lifted);
    const auto crossed =
        std::find_if(below.begin(), below.end(), [&](Index other) { return crossing.contains(pair_of(body, other)); });
    if (crossed == below.end()) {
      const bool free = !crossing.contains({body, body}) && find_intersections(obstacles, surface, lifted, body).empty();
      return free ? std::optional(lifted) : std::nullopt;
    }
    const auto next = lift.off(*crossed, lifted);
    if (!next) return std::nullopt;
    lifted = *next;
  }
  return std::nullopt;
}

}  // namespace sprung
