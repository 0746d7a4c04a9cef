// BVH over the network's moving elements: which of them may come near each other.
#pragma once

#include "base/parallel.h"
#include "collision/element_bvh/element_bvh_leaf.h"
#include "collision/surface/collision_surface.h"

#include <vector>

namespace sprung {

class ElementBvh {
 public:
  /// Leaves group elements of one body that are neighbours at `rest` [m], 3 x n. Keeps a reference to the surface.
  ElementBvh(const CollisionSurface& surface, const Points& rest);

  /// Marks these elements and unmarks all others.
  void mark(const std::vector<Index>& elements);

  /// Marks these elements, unmarks all others, and bounds the spheres of the marked elements' particles from time 0 to the end.
  /// Unmarked elements keep their bounds. `flat` has the results of fan_stays_flat() by particle.
  void bound(const VertexBounds& spheres, const std::vector<char>& flat, const std::vector<Index>& elements, HorizonTimes times);

  [[nodiscard]] Index leaf_count() const { return static_cast<Index>(leaves_.size()); }
  [[nodiscard]] const ElementBvhLeaf& leaf(Index number) const { return leaves_[static_cast<std::size_t>(number)]; }

  /// Two leaves, or one and itself.
  struct LeafPair {
    Index first = kNone;
    Index second = kNone;
  };
  /// Pairs of leaves that may come within `margin` [m] of each other between now and the end. Their bodies collide with each other,
  /// and one of the two has a marked element. The order does not depend on the number of threads.
  [[nodiscard]] std::vector<LeafPair> find_pairs(HorizonTimes times, double margin) const;

  /// Calls `visit(number)` once for each leaf of the pairs, in any order and from several threads.
  template <class Visit>
  void for_each_leaf(const std::vector<LeafPair>& pairs, const Visit& visit) const;

 private:
  struct Node {
    KineticAabb bounds;
    KineticAabb marked_bounds;  ///< of the marked elements below; not set if none is marked
    Index left = kNone;         ///< kNone for a leaf
    Index right = kNone;
    Index leaf = kNone;
    Index leaves = 0;    ///< below it
    Index body = kNone;  ///< kNone if there are several
    bool marked = false;
  };

  struct Slot {
    Index leaf = kNone;
    int lane = 0;
  };

  struct NodePair {
    Index a;
    Index b;
  };

  /// Interval and distance of a query.
  struct Search {
    float now;
    float end;
    float margin;
  };

  template <Same<Node> S, class Visit>
  friend void visit_members(S& n, const Visit& visit) {
    visit(n.bounds);
  }
  template <Same<ElementBvh> S, class Visit>
  friend void visit_members(S& t, const Visit& visit) {
    visit(fixed_size(t.leaves_), fixed_size(t.nodes_));
  }

  void add_leaf(const std::vector<Index>& order, std::size_t begin, std::size_t end);
  Index add_bodies(std::size_t begin, std::size_t end);
  Index add_node(Index begin, Index end, Index body);
  void mark_lanes(const std::vector<Index>& elements);
  void bound_marked();
  void bound_node(Node& node) const;
  [[nodiscard]] ElementBvhLeaf& own_leaf(Index number) { return leaves_[static_cast<std::size_t>(number)]; }
  [[nodiscard]] const Node& node(Index number) const { return nodes_[static_cast<std::size_t>(number)]; }
  [[nodiscard]] bool bodies_may_collide(Index a, Index b) const;
  [[nodiscard]] bool may_touch(NodePair pair, const Search& search) const;
  [[nodiscard]] std::vector<NodePair> find_tasks(const Search& search) const;
  void open(NodePair pair, std::vector<NodePair>& pairs) const;
  void traverse(NodePair pair, const Search& search, std::vector<LeafPair>& found) const;

  const CollisionSurface& surface_;
  Vector3 origin_;  ///< of the leaves' coordinates: single precision is coarse far from it [m]
  std::vector<ElementBvhLeaf> leaves_;
  std::vector<Index> first_leaf_;  ///< by body, and the end
  std::vector<Node> nodes_;        ///< parents before their children
  std::vector<Index> node_of_leaf_;
  std::vector<Slot> slots_;    ///< by element
  std::vector<Index> marked_;  ///< leaves that have a marked element
};

template <class Visit>
void ElementBvh::for_each_leaf(const std::vector<LeafPair>& pairs, const Visit& visit) const {
  constexpr Index kLeavesPerTask = 64;
  std::vector<char> needed(leaves_.size(), 0);
  for (const LeafPair& pair : pairs) {
    needed[static_cast<std::size_t>(pair.first)] = 1;
    needed[static_cast<std::size_t>(pair.second)] = 1;
  }
  parallel_chunks(leaf_count(), kLeavesPerTask, [&](Index begin, Index end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      if (needed[k] != 0) visit(k);
    }
  });
}

}  // namespace sprung
