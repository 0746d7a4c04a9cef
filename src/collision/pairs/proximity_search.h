// The corners before faces, and the sharp edges, that contact keeps an eye on.
//
// Nothing passes whatever this finds: it is for response, which wants one contact where surfaces meet, not all that are near.
#pragma once

#include "collision/element_bvh/edge_edge_filter.h"
#include "collision/element_bvh/element_bvh.h"
#include "collision/pairs/contact_candidate.h"
#include "collision/surface/feature_edges.h"

#include <vector>

namespace sprung {

class ProximitySearch {
 public:
  /// Contact looks `margin` [m] beyond its gap. Within a body, what is near each other at `rest` [m], 3 x n, keeps only a part of
  /// that distance as gap and margin, so that neighbours do not push each other. Keeps references to all.
  ProximitySearch(const CollisionSurface& surface, const SurfaceTopology& features, const FeatureEdges& sharp,
                  const ElementBvh& tree, const Points& rest, double margin);

  /// All with a particle that is marked that may come within contact's reach from now to the end while particles are in their
  /// balls, those that the tree bounds: corners above faces, and pairs of sharp edges. The same for any number of threads.
  [[nodiscard]] std::vector<ContactCandidate> find_candidates(const VertexBounds& balls, const std::vector<char>& marked,
                                                              HorizonTimes times);

 private:
  /// A leaf of the tree, with what of it contact looks at.
  struct Side {
    const ElementBvhLeaf* leaf = nullptr;
    std::vector<std::array<int, 2>> corners;  ///< lane and corner of those that the leaf's elements own
    LeafBounds places{};
    std::vector<std::array<int, 2>> edges;  ///< lane and edge of those
    std::vector<std::array<int, 2>> sharp;  ///< those of them that are
    std::vector<EdgeLanes> sharp_lanes{};   ///< the same, eight by eight
    float largest_radius = 0.0F;            ///< of its balls [m]
    float longest_way = 0.0F;               ///< of its particles in a step, about [m]
  };
  struct Search {
    const VertexBounds& balls;
    const std::vector<char>& marked;
    HorizonTimes times;
  };

  void prepare_sides(const std::vector<ElementBvh::LeafPair>& pairs, const Search& search);
  void prepare(Side& side, const Search& search) const;
  void prepare_edges(Side& side, const Search& search) const;
  /// Double4 of side `a` that may have something near side `b`, with one of both marked.
  [[nodiscard]] LaneBytes lanes_near(const Side& a, const Side& b, const Search& search) const;
  void append_corners(const Side& a, const Side& b, const LaneBytes& near, const Search& search,
                      std::vector<ContactCandidate>& candidates) const;
  void append_edges(const Side& a, const Side& b, const LaneBytes& near, const Search& search,
                    std::vector<ContactCandidate>& candidates) const;
  /// Those that come near the edge of side `a` with this number, from a number of side `b` on.
  void append_edges_near(const Side& a, std::size_t own, const Side& b, std::size_t from, const Search& search,
                         std::vector<ContactCandidate>& candidates) const;
  void append_if_near(ContactCandidate candidate, const Search& search, std::vector<ContactCandidate>& candidates) const;
  /// Largest displacement of a particle of the stencil in a step, estimated as its ball's motion plus the ball's radius [m].
  [[nodiscard]] static double largest_displacement(const ContactStencil& stencil, const Search& search);
  /// Upper bound of the reach between a vertex or edge of `a` and one of `b` [m].
  [[nodiscard]] float reach_between(const Side& a, const Side& b) const;
  /// How much closer to each other the particles may be than the centers of their balls [m].
  [[nodiscard]] static double largest_stray(const ContactStencil& stencil, const Search& search);
  /// Lower bound of the distance between the balls' centers over the interval [m]; sets the stencil's normal.
  [[nodiscard]] static double least_distance(ContactStencil& stencil, const Search& search);
  [[nodiscard]] const Element& element(Index number) const { return surface_.elements[static_cast<std::size_t>(number)]; }
  [[nodiscard]] double thickness(Index number) const { return surface_.thickness[element(number).particles[0]]; }

  const CollisionSurface& surface_;
  const SurfaceTopology& features_;
  const FeatureEdges& sharp_;
  const ElementBvh& tree_;
  const Points& rest_;
  double margin_;
  double largest_gap_;       ///< [m]
  std::vector<Side> sides_;  ///< by leaf
};

}  // namespace sprung
