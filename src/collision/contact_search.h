// The corners before faces, and the sharp edges, that contact keeps an eye on.
//
// Nothing passes whatever this finds: it is for response, which wants one contact where surfaces meet, not all that are near.
#pragma once

#include "collision/contact_candidate.h"
#include "collision/element_tree.h"
#include "collision/sharp_edges.h"

#include <vector>

namespace sprung {

class ContactSearch {
 public:
  /// Contact looks `margin` [m] beyond its gap. Within a body, what is near each other at `rest` [m], 3 x n, keeps only a part of
  /// that distance as gap and margin, so that neighbours do not push each other. Keeps references to all.
  ContactSearch(const CollisionSurface& surface, const SurfaceFeatures& features, const SharpEdges& sharp, const ElementTree& tree,
                const Points& rest, double margin);

  /// All with a particle that is marked that may come within contact's reach from now to the end while particles are in their
  /// balls, those that the tree bounds: corners above faces, and pairs of sharp edges. The same for any number of threads.
  [[nodiscard]] std::vector<ContactCandidate> find_candidates(const MovingBalls& balls, const std::vector<char>& marked,
                                                              WatchTimes times);

 private:
  /// A leaf of the tree, with what of it contact looks at.
  struct Side {
    const ElementLeaf* leaf = nullptr;
    std::vector<std::array<int, 2>> corners;  ///< lane and corner of those that the leaf's elements own
    LeafPlaces places{};
    bool sharp[kTreeLanes]{};  ///< by lane: the element owns a sharp edge
    bool any_sharp = false;
    float largest_radius = 0.0F;  ///< of its balls [m]
  };
  struct Search {
    const MovingBalls& balls;
    const std::vector<char>& marked;
    WatchTimes times;
  };

  void prepare_sides(const std::vector<ElementTree::LeafPair>& pairs, WatchTimes times);
  void prepare(Side& side, WatchTimes times) const;
  void append_corners(const Side& a, const Side& b, const Search& search, std::vector<ContactCandidate>& candidates) const;
  void append_edges(const Side& a, const Side& b, const Search& search, std::vector<ContactCandidate>& candidates) const;
  void append_edges_of(Index first, Index second, const Search& search, std::vector<ContactCandidate>& candidates) const;
  void append_if_near(ContactCandidate candidate, const Search& search, std::vector<ContactCandidate>& candidates) const;
  /// A lower bound of the distance of their balls' centers until the end; sets the normal.
  [[nodiscard]] static double largest_stray(const ContactCandidate& candidate, const Search& search);
  [[nodiscard]] static double least_distance(ContactCandidate& candidate, const Search& search);
  [[nodiscard]] bool owns_sharp_edge(Index number) const;
  [[nodiscard]] const Element& element(Index number) const { return surface_.elements[static_cast<std::size_t>(number)]; }
  [[nodiscard]] double thickness(Index number) const { return surface_.thickness[element(number).particles[0]]; }

  const CollisionSurface& surface_;
  const SurfaceFeatures& features_;
  const SharpEdges& sharp_;
  const ElementTree& tree_;
  const Points& rest_;
  double margin_;
  double largest_reach_;     ///< of contact between balls [m]
  std::vector<Side> sides_;  ///< by leaf
};

}  // namespace sprung
