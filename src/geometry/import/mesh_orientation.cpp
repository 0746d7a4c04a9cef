#include "geometry/import/mesh_orientation.h"

#include "geometry/mesh/topology.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace sprung {
namespace {

// A volume below this fraction of area times extent is rounding error: mesh files have single precision.
constexpr double kNoVolume = 0x1p-23;

// A maximal set of faces joined by edges that exactly two faces share.
struct Component {
  std::vector<Index> faces;
  Triangles triangles;  // of these faces, wound consistently
  Box3 box;
  double volume = 0.0;
  bool closed = false;
  bool flat = false;           // closed, but encloses no volume
  bool flip_as_given = false;  // whether a flip makes `triangles` agree with most of the original faces
  bool flip = false;           // whether `triangles` are flipped
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

// Searches breadth first from the lowest face, so that components and their order depend on the mesh alone.
class ComponentFinder {
 public:
  explicit ComponentFinder(const Triangles& triangles)
      : neighbours_(neighbours(triangles)), turned_(triangles.cols(), false), seen_(triangles.cols(), false) {}

  std::vector<Component> find() {
    std::vector<Component> components;
    for (Index seed = 0; seed < std::ssize(seen_); ++seed) {
      if (!seen_[seed]) components.push_back(grow(seed));
    }
    return components;
  }

  [[nodiscard]] const std::vector<bool>& turned() const { return turned_; }
  [[nodiscard]] Index one_sided_components() const { return one_sided_components_; }

 private:
  Component grow(Index seed) {
    Component component;
    component.faces = {seed};
    seen_[seed] = true;
    bool two_sided = true;
    for (std::size_t next = 0; next < component.faces.size(); ++next) {
      const Index face = component.faces[next];
      for (const Neighbour& neighbour : neighbours_[face]) {
        const bool wanted = turned_[face] == neighbour.agrees;
        if (seen_[neighbour.face]) {
          two_sided = two_sided && turned_[neighbour.face] == wanted;
          continue;
        }
        seen_[neighbour.face] = true;
        turned_[neighbour.face] = wanted;
        component.faces.push_back(neighbour.face);
      }
    }
    if (!two_sided) ++one_sided_components_;
    return component;
  }

  std::vector<std::vector<Neighbour>> neighbours_;
  std::vector<bool> turned_;
  std::vector<bool> seen_;
  Index one_sided_components_ = 0;
};

void measure(Component& component, const TriangleMesh& mesh, const std::vector<bool>& turned) {
  component.triangles.resize(3, std::ssize(component.faces));
  for (Index t = 0; t < component.triangles.cols(); ++t) {
    component.triangles.col(t) = mesh.triangles.col(component.faces[t]);
    if (turned[component.faces[t]]) std::swap(component.triangles(1, t), component.triangles(2, t));
  }
  const auto turns = std::count_if(component.faces.begin(), component.faces.end(), [&](Index face) { return turned[face]; });
  component.flip_as_given = 2 * turns > std::ssize(component.faces);
  component.flip = component.flip_as_given;
  component.closed = is_closed(component.triangles);
  if (!component.closed) return;
  component.volume = signed_volume(mesh.vertices, component.triangles);
  for (const Index vertex : component.triangles.reshaped()) component.box.extend(Vector3(mesh.vertices.col(vertex)));
  double area = 0.0;
  for (const auto& corners : component.triangles.colwise()) {
    area += 0.5 * area_normal(mesh.vertices.col(corners[0]), mesh.vertices.col(corners[1]), mesh.vertices.col(corners[2])).norm();
  }
  component.flat = std::abs(component.volume) <= kNoVolume * area * component.box.diagonal().norm();
}

// By the winding number, a sum of solid angles (Van Oosterom and Strackee 1983). Unlike a ray, it cannot hit an edge.
bool encloses(const Component& component, const Points& vertices, const Vector3& point) {
  double angle = 0.0;
  for (const auto& corners : component.triangles.colwise()) {
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

// From the largest closed component to the smallest, so that the components around one are oriented before it.
void turn_outward(std::vector<Component>& components, const Points& vertices) {
  std::vector<Component*> closed;
  for (Component& component : components) {
    if (component.closed) closed.push_back(&component);
  }
  std::stable_sort(closed.begin(), closed.end(),
                   [](const Component* a, const Component* b) { return std::abs(a->volume) > std::abs(b->volume); });
  for (std::size_t inner = 0; inner < closed.size(); ++inner) {
    Component& component = *closed[inner];
    const Vector3 point = vertices.col(component.triangles(0, 0));
    int depth = 0;
    const Component* around = nullptr;
    for (std::size_t outer = 0; outer < inner; ++outer) {
      if (!closed[outer]->box.contains(component.box) || !encloses(*closed[outer], vertices, point)) continue;
      around = closed[outer];
      ++depth;
    }
    const bool wall_of_cavity = depth % 2 == 1;
    component.flip = wall_of_cavity ? component.flip_as_given != (around->flip != around->flip_as_given) : component.volume < 0.0;
  }
}

}  // namespace

OrientationReport orient_faces(TriangleMesh& mesh) {
  ComponentFinder finder(mesh.triangles);
  std::vector<Component> components = finder.find();
  for (Component& component : components) measure(component, mesh, finder.turned());
  turn_outward(components, mesh.vertices);
  OrientationReport report{.one_sided_components = finder.one_sided_components()};
  for (const Component& component : components) {
    if (component.flat) ++report.flat_components;
    for (const Index face : component.faces) {
      if (finder.turned()[face] == component.flip) continue;
      std::swap(mesh.triangles(1, face), mesh.triangles(2, face));
      ++report.flipped_faces;
    }
  }
  return report;
}

}  // namespace sprung
