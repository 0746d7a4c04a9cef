#include "geometry/import/mesh_orientation.h"

#include "geometry/mesh/topology.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace sprung {
namespace {

// As a part of area times extent, a volume that is rounding: mesh files hold single precision.
constexpr double kNoVolume = 0x1p-23;

// A maximal set of faces joined by edges that exactly two faces share.
struct Part {
  std::vector<Index> faces;
  Triangles triangles;  // of these faces, wound consistently
  Box3 box;
  double volume = 0.0;
  bool closed = false;
  bool flat = false;           // closed, around nothing
  bool flip_as_given = false;  // what makes `triangles` agree with most of the faces as they were
  bool flip = false;           // what is done with them
};

struct Neighbour {
  Index face;
  bool agrees;  // runs along the shared edge in the opposite direction
};

std::vector<std::vector<Neighbour>> neighbours(const Triangles& triangles) {
  std::vector<std::vector<Neighbour>> result(triangles.cols());
  for (const MeshEdge& edge : mesh_edges(triangles)) {
    if (edge.uses != 2) continue;
    const bool agrees = edge.forward[0] != edge.forward[1];
    result[edge.triangles[0]].push_back({edge.triangles[1], agrees});
    result[edge.triangles[1]].push_back({edge.triangles[0], agrees});
  }
  return result;
}

// Breadth first from the lowest face, so that parts and their order depend on the mesh alone.
class PartFinder {
 public:
  explicit PartFinder(const Triangles& triangles)
      : neighbours_(neighbours(triangles)), turned_(triangles.cols(), false), seen_(triangles.cols(), false) {}

  std::vector<Part> find() {
    std::vector<Part> parts;
    for (Index seed = 0; seed < std::ssize(seen_); ++seed) {
      if (!seen_[seed]) parts.push_back(grow(seed));
    }
    return parts;
  }

  [[nodiscard]] const std::vector<bool>& turned() const { return turned_; }
  [[nodiscard]] Index one_sided_parts() const { return one_sided_parts_; }

 private:
  Part grow(Index seed) {
    Part part;
    part.faces = {seed};
    seen_[seed] = true;
    bool two_sided = true;
    for (std::size_t next = 0; next < part.faces.size(); ++next) {
      const Index face = part.faces[next];
      for (const Neighbour& neighbour : neighbours_[face]) {
        const bool wanted = turned_[face] == neighbour.agrees;
        if (seen_[neighbour.face]) {
          two_sided = two_sided && turned_[neighbour.face] == wanted;
          continue;
        }
        seen_[neighbour.face] = true;
        turned_[neighbour.face] = wanted;
        part.faces.push_back(neighbour.face);
      }
    }
    if (!two_sided) ++one_sided_parts_;
    return part;
  }

  std::vector<std::vector<Neighbour>> neighbours_;
  std::vector<bool> turned_;
  std::vector<bool> seen_;
  Index one_sided_parts_ = 0;
};

void measure(Part& part, const TriangleMesh& mesh, const std::vector<bool>& turned) {
  part.triangles.resize(3, std::ssize(part.faces));
  for (Index t = 0; t < part.triangles.cols(); ++t) {
    part.triangles.col(t) = mesh.triangles.col(part.faces[t]);
    if (turned[part.faces[t]]) std::swap(part.triangles(1, t), part.triangles(2, t));
  }
  const auto turns = std::count_if(part.faces.begin(), part.faces.end(), [&](Index face) { return turned[face]; });
  part.flip_as_given = 2 * turns > std::ssize(part.faces);
  part.flip = part.flip_as_given;
  part.closed = is_closed(part.triangles);
  if (!part.closed) return;
  part.volume = signed_volume(mesh.vertices, part.triangles);
  for (const Index vertex : part.triangles.reshaped()) part.box.extend(Vector3(mesh.vertices.col(vertex)));
  double area = 0.0;
  for (const auto& corners : part.triangles.colwise()) {
    area += 0.5 * area_normal(mesh.vertices.col(corners[0]), mesh.vertices.col(corners[1]), mesh.vertices.col(corners[2])).norm();
  }
  part.flat = std::abs(part.volume) <= kNoVolume * area * part.box.diagonal().norm();
}

// The winding number, a sum of solid angles (Van Oosterom and Strackee 1983): unlike a ray it cannot hit an edge.
bool encloses(const Part& part, const Points& vertices, const Vector3& point) {
  double angle = 0.0;
  for (const auto& corners : part.triangles.colwise()) {
    const Vector3 a = vertices.col(corners[0]) - point;
    const Vector3 b = vertices.col(corners[1]) - point;
    const Vector3 c = vertices.col(corners[2]) - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(angle) > 2.0 * std::numbers::pi;
}

// From the largest closed part to the smallest, so that a part's surroundings are settled before it.
void turn_outward(std::vector<Part>& parts, const Points& vertices) {
  std::vector<Part*> closed;
  for (Part& part : parts) {
    if (part.closed) closed.push_back(&part);
  }
  std::stable_sort(closed.begin(), closed.end(),
                   [](const Part* a, const Part* b) { return std::abs(a->volume) > std::abs(b->volume); });
  for (std::size_t inner = 0; inner < closed.size(); ++inner) {
    Part& part = *closed[inner];
    const Vector3 point = vertices.col(part.triangles(0, 0));
    int depth = 0;
    const Part* around = nullptr;
    for (std::size_t outer = 0; outer < inner; ++outer) {
      if (!closed[outer]->box.contains(part.box) || !encloses(*closed[outer], vertices, point)) continue;
      around = closed[outer];
      ++depth;
    }
    const bool wall_of_cavity = depth % 2 == 1;
    part.flip = wall_of_cavity ? part.flip_as_given != (around->flip != around->flip_as_given) : part.volume < 0.0;
  }
}

}  // namespace

OrientationReport orient_faces(TriangleMesh& mesh) {
  PartFinder finder(mesh.triangles);
  std::vector<Part> parts = finder.find();
  for (Part& part : parts) measure(part, mesh, finder.turned());
  turn_outward(parts, mesh.vertices);
  OrientationReport report{.one_sided_parts = finder.one_sided_parts()};
  for (const Part& part : parts) {
    if (part.flat) ++report.flat_parts;
    for (const Index face : part.faces) {
      if (finder.turned()[face] == part.flip) continue;
      std::swap(mesh.triangles(1, face), mesh.triangles(2, face));
      ++report.flipped_faces;
    }
  }
  return report;
}

}  // namespace sprung
