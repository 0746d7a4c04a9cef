// Topology of the collision mesh: numbers and owners of edges, owners of corners, the fan of triangles around each particle, and
// feature edges, the boundaries and creases. Only feature edges need edge-edge contacts; elsewhere vertex-face contacts are enough.
#pragma once

#include "base/files/binary_archive.h"
#include "collision/surface/collision_surface.h"

#include <array>
#include <span>
#include <vector>

namespace sprung {

/// The triangles around a particle. Neighbouring spokes form a triangle with it; in a closed fan the last and the first do too.
enum class FanKind : std::uint8_t {
  none,  ///< no triangles, or they do not form a single fan: the spokes ascend
  open,
  closed
};

/// Corner k of an element is its particle k; edge k runs from it to the next one. A corner or edge of several elements is owned by
/// the first of them, so that each vertex-face and edge-edge pair is tested once.
[[nodiscard]] inline int edges_of(const Element& element) { return element.corners == 3 ? 3 : element.corners - 1; }

[[nodiscard]] inline std::array<Index, 2> ends_of(const Element& element, int edge) {
  return {element.particles[static_cast<std::size_t>(edge)],
          element.particles[static_cast<std::size_t>((edge + 1) % element.corners)]};
}

class SurfaceTopology {
 public:
  SurfaceTopology(const std::vector<Element>& elements, Index particles);

  [[nodiscard]] bool owns_corner(Index element, int corner) const { return (owned(element).corners >> corner & 1) != 0; }
  [[nodiscard]] bool owns_edge(Index element, int edge) const { return (owned(element).edges >> edge & 1) != 0; }

  /// Edges have numbers from 0, the same for all elements that share one.
  [[nodiscard]] Index edge(Index element, int edge) const { return edges_[slot(element, edge)]; }
  [[nodiscard]] Index edge_count() const { return static_cast<Index>(owners_.size()); }
  struct Side {
    Index element = kNone;
    int edge = 0;
  };
  [[nodiscard]] Side owner(Index edge) const { return owners_[static_cast<std::size_t>(edge)]; }

  /// The third corner of the other triangle at an edge of a triangle; kNone if there is no other triangle, or more than one.
  [[nodiscard]] Index across(Index element, int edge) const { return across_[slot(element, edge)]; }

  [[nodiscard]] FanKind fan(Index particle) const { return fans_[static_cast<std::size_t>(particle)]; }

  /// The other corners of the triangles around a particle.
  [[nodiscard]] std::span<const Index> spokes(Index particle) const { return row(first_spoke_, spokes_, particle); }

  /// The elements that have the particle as a corner, ascending.
  [[nodiscard]] std::span<const Index> elements_at(Index particle) const { return row(first_element_, elements_, particle); }

 private:
  struct Owned {
    std::uint8_t corners = 0;
    std::uint8_t edges = 0;
  };

  [[nodiscard]] const Owned& owned(Index element) const { return owned_[static_cast<std::size_t>(element)]; }
  [[nodiscard]] static std::size_t slot(Index element, int edge) {
    return 3 * static_cast<std::size_t>(element) + static_cast<std::size_t>(edge);
  }
  [[nodiscard]] static std::span<const Index> row(const std::vector<Index>& first, const std::vector<Index>& values, Index number) {
    const auto i = static_cast<std::size_t>(number);
    return {values.data() + first[i], static_cast<std::size_t>(first[i + 1] - first[i])};
  }

  void list_elements(const std::vector<Element>& elements, Index particles);
  void give_corners(const std::vector<Element>& elements);
  void give_edges(const std::vector<Element>& elements);
  void join(const std::vector<Element>& elements, Side side, Side other);
  void build_fans(const std::vector<Element>& elements, Index particles);

  std::vector<Owned> owned_;
  std::vector<Index> edges_;
  std::vector<Side> owners_;
  std::vector<Index> across_;
  std::vector<Index> first_element_;
  std::vector<Index> elements_;
  std::vector<FanKind> fans_;
  std::vector<Index> first_spoke_;
  std::vector<Index> spokes_;
};

class FeatureEdges {
 public:
  /// All edges are sharp at first. Keeps references to both arguments.
  FeatureEdges(const CollisionSurface& surface, const SurfaceTopology& features);

  /// Classifies all edges for the particles at `positions` [m].
  void update(const Points& positions);

  /// Whether the edge does not belong to exactly two triangles, or their normals differ by more than 45 degrees.
  [[nodiscard]] bool is_sharp(Index edge) const { return sharp_[static_cast<std::size_t>(edge)] != 0; }

 private:
  [[nodiscard]] bool is_bent(Index edge, const Points& positions) const;

  template <Same<FeatureEdges> S, class Visit>
  friend void visit_members(S& f, const Visit& visit) {
    visit(fixed_size(f.sharp_));
  }

  const CollisionSurface& surface_;
  const SurfaceTopology& features_;
  std::vector<char> sharp_;  ///< by edge
};

}  // namespace sprung
