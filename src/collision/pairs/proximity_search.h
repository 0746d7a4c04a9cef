// Proximity search: vertex-face pairs and pairs of feature edges within contact's reach.
//
// Its result serves contact response, which needs one contact where surfaces touch. Non-penetration does not depend on it.
#pragma once

#include "collision/element_bvh/element_bvh.h"
#include "collision/element_bvh/feature_filters.h"
#include "collision/pairs/element_contacts.h"
#include "collision/surface/surface_topology.h"

#include <vector>

namespace sprung {

class ProximitySearch {
 public:
  /// Contacts are found up to `margin` [m] beyond their gap. Within a body, gap and margin are limited to a fraction of the
  /// distance at `rest` [m], 3 x n, so that neighbours do not push each other. Keeps references to all arguments.
  ProximitySearch(const CollisionSurface& surface, const SurfaceTopology& topology, const FeatureEdges& feature_edges,
                  const ElementBvh& tree, const Points& rest, double margin);

  /// Candidates with a marked particle that may come within their reach between now and the end while particles are in their
  /// spheres: vertices above faces, and pairs of feature edges. Requires that the tree bounds these spheres. The order does not
  /// depend on the number of threads.
  [[nodiscard]] std::vector<ContactCandidate> find_candidates(const VertexBounds& spheres, const std::vector<char>& marked,
                                                              HorizonTimes times);

 private:
  /// A leaf of the tree and its features.
  struct Side {
    const ElementBvhLeaf* leaf = nullptr;
    std::vector<std::array<int, 2>> vertices;  ///< lane and corner of each vertex that the leaf's elements own
    LeafCorners corners{};
    std::vector<std::array<int, 2>> edges;          ///< lane and number of each edge that they own
    std::vector<std::array<int, 2>> feature_edges;  ///< the feature edges among them
    std::vector<EdgeLanes> edge_lanes{};            ///< the same edges, eight at a time
    float largest_radius = 0.0F;                    ///< of the leaf's spheres [m]
    float largest_displacement = 0.0F;              ///< of its particles in a step, estimated [m]
  };
  struct Search {
    const VertexBounds& spheres;
    const std::vector<char>& marked;
    HorizonTimes times;
  };

  void prepare(Side& side, const Search& search) const;
  void prepare_edges(Side& side, const Search& search) const;
  /// Lanes of `a` that may be near a lane of `b` such that one of the two is marked.
  [[nodiscard]] LaneBytes lanes_near(const Side& a, const Side& b, const Search& search) const;
  void append_vertices(const Side& a, const Side& b, const LaneBytes& near, const Search& search,
                       std::vector<ContactCandidate>& candidates) const;
  void append_edges(const Side& a, const Side& b, const LaneBytes& near, const Search& search,
                    std::vector<ContactCandidate>& candidates) const;
  /// Candidates of one feature edge of `a` with those of `b` from number `from` on.
  void append_edges_near(const Side& a, std::size_t own, const Side& b, std::size_t from, const Search& search,
                         std::vector<ContactCandidate>& candidates) const;
  void append_if_near(ContactCandidate candidate, const Search& search, std::vector<ContactCandidate>& candidates) const;
  /// Largest displacement of a particle of the stencil in a step, estimated as its sphere's motion plus the sphere's radius [m].
  [[nodiscard]] static double largest_displacement(const ContactStencil& stencil, const Search& search);
  /// Upper bound of the reach between a vertex or edge of `a` and one of `b` [m].
  [[nodiscard]] float reach_between(const Side& a, const Side& b) const;
  /// How much closer to each other the particles may be than the centers of their spheres [m].
  [[nodiscard]] static double largest_stray(const ContactStencil& stencil, const Search& search);
  /// Lower bound of the distance between the spheres' centers over the interval [m]; sets the stencil's normal.
  [[nodiscard]] static double least_distance(ContactStencil& stencil, const Search& search);
  [[nodiscard]] const Element& element(Index number) const { return surface_.elements[static_cast<std::size_t>(number)]; }
  [[nodiscard]] double thickness(Index number) const { return surface_.thickness[element(number).particles[0]]; }

  const CollisionSurface& surface_;
  const SurfaceTopology& topology_;
  const FeatureEdges& feature_edges_;
  const ElementBvh& tree_;
  const Points& rest_;
  double margin_;
  double largest_gap_;       ///< [m]
  std::vector<Side> sides_;  ///< by leaf
};

}  // namespace sprung
