// A tree over the network's elements as they move: which of them may come near each other.
#pragma once

#include "collision/element_bvh/element_bvh_leaf.h"
#include "collision/surface/collision_surface.h"

#include <vector>

namespace sprung {

class ElementBvh {
 public:
  /// Elements of a body that are neighbours at `rest` [m], 3 x n, share a leaf. Keeps a reference to the surface.
  ElementBvh(const CollisionSurface& surface, const Points& rest);

  /// Marks these elements and no others.
  void mark(const std::vector<Index>& elements);

  /// Marks them, and bounds, from time 0 to the end, the balls of their corners. Elements that are not marked keep the bounds that
  /// they have. `flat`, by particle: see fan_stays_flat().
  void bound(const VertexBounds& balls, const std::vector<char>& flat, const std::vector<Index>& elements, HorizonTimes times);

  [[nodiscard]] Index leaf_count() const { return static_cast<Index>(leaves_.size()); }
  [[nodiscard]] const ElementBvhLeaf& leaf(Index number) const { return leaves_[static_cast<std::size_t>(number)]; }

  /// Two leaves, or one and itself.
  struct LeafPair {
    Index first = kNone;
    Index second = kNone;
  };
  /// Leaves that may come within `margin` [m] of each other between now and the end and whose bodies may meet, one of them with an
  /// element that is marked. The same for any number of threads.
  [[nodiscard]] std::vector<LeafPair> find_pairs(HorizonTimes times, double margin) const;

 private:
  struct Node {
    KineticAabb bounds;
    KineticAabb marked_bounds;  ///< of the elements below that are marked; meaningless if none is
    Index left = kNone;         ///< kNone for a leaf
    Index right = kNone;
    Index leaf = kNone;
    Index leaves = 0;    ///< below it
    Index body = kNone;  ///< kNone where there are several
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

  /// What is asked for.
  struct Search {
    float now;
    float end;
    float margin;
  };

  void add_leaf(const std::vector<Index>& order, std::size_t begin, std::size_t end);
  Index add_bodies(std::size_t begin, std::size_t end);
  Index add_node(Index begin, Index end, Index body);
  void mark_lanes(const std::vector<Index>& elements);
  void bound_marked();
  void bound_node(Node& node) const;
  [[nodiscard]] ElementBvhLeaf& own_leaf(Index number) { return leaves_[static_cast<std::size_t>(number)]; }
  [[nodiscard]] const Node& node(Index number) const { return nodes_[static_cast<std::size_t>(number)]; }
  [[nodiscard]] bool bodies_may_meet(Index a, Index b) const;
  [[nodiscard]] bool may_meet(NodePair pair, const Search& search) const;
  [[nodiscard]] std::vector<NodePair> find_tasks(const Search& search) const;
  void open(NodePair pair, std::vector<NodePair>& pairs) const;
  void walk(NodePair pair, const Search& search, std::vector<LeafPair>& found) const;

  const CollisionSurface& surface_;
  Vector3 origin_;  ///< of what leaves hold: single precision tells little apart far from it [m]
  std::vector<ElementBvhLeaf> leaves_;
  std::vector<Index> first_leaf_;  ///< by body, and the end
  std::vector<Node> nodes_;        ///< parents before their children
  std::vector<Index> node_of_leaf_;
  std::vector<Slot> slots_;    ///< by element
  std::vector<Index> marked_;  ///< leaves that have a marked element
};

}  // namespace sprung
