#include "scenarios/judge.h"

#include "scenarios/primitive_judge.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace sprung::testing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Segment = Kernel::Segment_3;
using Triangle = Kernel::Triangle_3;
using BoxOfElement = CGAL::Box_intersection_d::Box_with_info_d<double, 3, Index>;

Point to_point(const Vector3& p) { return {p.x(), p.y(), p.z()}; }

struct Corners {
  std::array<Point, 3> points;
  int count = 0;

  [[nodiscard]] Segment segment(int from, int to) const {
    return {points[static_cast<std::size_t>(from)], points[static_cast<std::size_t>(to)]};
  }
  [[nodiscard]] Triangle triangle() const { return {points[0], points[1], points[2]}; }
  [[nodiscard]] CGAL::Bbox_3 bbox() const {
    CGAL::Bbox_3 box = points[0].bbox();
    for (int i = 1; i < count; ++i) box += points[static_cast<std::size_t>(i)].bbox();
    return box;
  }
};

Corners corners_of(const JudgedElement& element, const Points& positions) {
  Corners result{.points = {}, .count = element.corners};
  for (std::size_t i = 0; i < static_cast<std::size_t>(element.corners); ++i) {
    result.points[i] = to_point(positions.col(element.particles[i]));
  }
  return result;
}

bool intersect(const Corners& a, const Corners& b) {
  if (a.count > b.count) return intersect(b, a);
  if (b.count == 2) return CGAL::do_intersect(a.segment(0, 1), b.segment(0, 1));
  if (a.count == 2) return CGAL::do_intersect(a.segment(0, 1), b.triangle());
  return CGAL::do_intersect(a.triangle(), b.triangle());
}

/// Reorders the corners of an element so that those shared with the other element come first. Returns the number of shared corners.
int shared_first(const JudgedElement& element, const JudgedElement& other, Corners& corners) {
  int shared = 0;
  for (int i = 0; i < element.corners; ++i) {
    const auto* end = other.particles.begin() + other.corners;
    if (std::find(other.particles.begin(), end, element.particles[static_cast<std::size_t>(i)]) == end) continue;
    std::swap(corners.points[static_cast<std::size_t>(i)], corners.points[static_cast<std::size_t>(shared)]);
    ++shared;
  }
  return shared;
}

/// The side of a triangle opposite its first corner.
Segment opposite(const Corners& triangle) { return triangle.segment(1, 2); }

// Requires that the first corner of both is the shared one. A ray from it through another common point leaves one of the elements
// first, at the end or side opposite the corner, while it is still in the other. So it suffices to test these ends and sides.
bool intersect_beyond_corner(const Corners& a, const Corners& b) {
  if (a.count > b.count) return intersect_beyond_corner(b, a);
  const Point& corner = a.points[0];
  if (b.count == 2) {
    return CGAL::collinear(corner, a.points[1], b.points[1]) && CGAL::angle(a.points[1], corner, b.points[1]) == CGAL::ACUTE;
  }
  if (a.count == 2) return CGAL::do_intersect(a.segment(0, 1), opposite(b)) || CGAL::do_intersect(b.triangle(), a.points[1]);
  return CGAL::do_intersect(opposite(a), b.triangle()) || CGAL::do_intersect(opposite(b), a.triangle());
}

// Requires that the first two corners of both are the shared ones. Triangles intersect beyond a shared edge only if they are folded
// flat onto each other.
bool intersect_beyond_edge(const Corners& a, const Corners& b) {
  return a.count == 3 && b.count == 3 && CGAL::coplanar(a.points[0], a.points[1], a.points[2], b.points[2]) &&
         CGAL::coplanar_orientation(a.points[0], a.points[1], a.points[2], b.points[2]) == CGAL::POSITIVE;
}

bool intersect_beyond_shared(const JudgedElement& a, const JudgedElement& b, Corners corners_a, Corners corners_b) {
  const int shared = shared_first(a, b, corners_a);
  shared_first(b, a, corners_b);
  if (shared == 0) return intersect(corners_a, corners_b);
  return shared == 1 ? intersect_beyond_corner(corners_a, corners_b) : intersect_beyond_edge(corners_a, corners_b);
}

class MeshJudge final : public ObstacleJudge {
 public:
  MeshJudge(const TriangleMesh& mesh, bool closed);

  [[nodiscard]] Index count_inside(const Points& positions) const override;
  [[nodiscard]] Index count_crossings(const std::vector<JudgedElement>& elements, const Points& positions) const override;
  [[nodiscard]] double distance(const Vector3& point) const override;

 private:
  using SurfaceMesh = CGAL::Surface_mesh<Point>;
  using TrianglesIterator = std::vector<Triangle>::const_iterator;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, TrianglesIterator>>>;

  void build_inside(const TriangleMesh& mesh);

  std::vector<Triangle> triangles_;
  Tree tree_;
  SurfaceMesh surface_;
  std::optional<CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel>> side_;
};

MeshJudge::MeshJudge(const TriangleMesh& mesh, bool closed) {
  for (const auto& triangle : mesh.triangles.colwise()) {
    triangles_.push_back(corners_of({{triangle[0], triangle[1], triangle[2]}, 3}, mesh.vertices).triangle());
  }
  tree_.insert(triangles_.begin(), triangles_.end());
  tree_.accelerate_distance_queries();
  if (closed) build_inside(mesh);
}

void MeshJudge::build_inside(const TriangleMesh& mesh) {
  std::vector<SurfaceMesh::Vertex_index> vertices;
  for (const auto& vertex : mesh.vertices.colwise()) vertices.push_back(surface_.add_vertex(to_point(vertex)));
  const auto vertex = [&](Index i) { return vertices[static_cast<std::size_t>(i)]; };
  for (const auto& triangle : mesh.triangles.colwise()) {
    if (surface_.add_face(vertex(triangle[0]), vertex(triangle[1]), vertex(triangle[2])) == SurfaceMesh::null_face()) {
      throw std::invalid_argument("a closed mesh that is judged must be an oriented manifold");
    }
  }
  side_.emplace(surface_);
}

Index MeshJudge::count_inside(const Points& positions) const {
  if (!side_) return 0;
  Index count = 0;
  for (const auto& position : positions.colwise()) count += (*side_)(to_point(position)) != CGAL::ON_UNBOUNDED_SIDE ? 1 : 0;
  return count;
}

Index MeshJudge::count_crossings(const std::vector<JudgedElement>& elements, const Points& positions) const {
  std::size_t count = 0;
  for (const JudgedElement& element : elements) {
    const Corners corners = corners_of(element, positions);
    count += corners.count == 2 ? tree_.number_of_intersected_primitives(corners.segment(0, 1))
                                : tree_.number_of_intersected_primitives(corners.triangle());
  }
  return static_cast<Index>(count);
}

double MeshJudge::distance(const Vector3& point) const { return std::sqrt(tree_.squared_distance(to_point(point))); }

}  // namespace

std::vector<JudgedElement> judged_elements(const SpringNetwork& network) {
  std::vector<JudgedElement> elements;
  for (const Body& body : network.bodies) {
    const Index first = body.first_particle;
    for (const auto& triangle : body.surface.triangles.colwise()) {
      elements.push_back({{first + triangle[0], first + triangle[1], first + triangle[2]}, 3});
    }
    for (const auto& segment : body.surface.segments.colwise()) {
      elements.push_back({{first + segment[0], first + segment[1], kNone}, 2});
    }
  }
  return elements;
}

Index count_self_crossings(const std::vector<JudgedElement>& elements, const Points& positions) {
  std::vector<Corners> corners;
  std::vector<BoxOfElement> boxes;
  for (const JudgedElement& element : elements) {
    corners.push_back(corners_of(element, positions));
    boxes.emplace_back(corners.back().bbox(), static_cast<Index>(boxes.size()));
  }
  Index count = 0;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const BoxOfElement& a, const BoxOfElement& b) {
    const auto i = static_cast<std::size_t>(a.info());
    const auto k = static_cast<std::size_t>(b.info());
    count += intersect_beyond_shared(elements[i], elements[k], corners[i], corners[k]) ? 1 : 0;
  });
  return count;
}

double segment_distance(const Points& positions, const std::array<Index, 2>& a, const std::array<Index, 2>& b) {
  const auto point = [&](Index i) { return to_point(positions.col(i)); };
  return std::sqrt(CGAL::squared_distance(Segment(point(a[0]), point(a[1])), Segment(point(b[0]), point(b[1]))));
}

std::unique_ptr<const ObstacleJudge> judge_of(const TriangleMesh& mesh, bool closed) {
  return std::make_unique<MeshJudge>(mesh, closed);
}

std::unique_ptr<const ObstacleJudge> judge_of(const ObstacleGeometry& geometry, double time) {
  if (const auto* mesh = std::get_if<MeshGeometry>(&geometry)) return judge_of(*mesh->mesh, mesh->closed);
  if (const auto* deforming = std::get_if<SequenceGeometry>(&geometry)) {
    const MeshSequence& sequence = *deforming->sequence;
    TriangleMesh now{.vertices = {}, .triangles = sequence.triangles};
    sequence.positions(sequence.at(time), now.vertices);
    return judge_of(now, deforming->closed);
  }
  return judge_of_primitive(geometry);
}

}  // namespace sprung::testing
