// The parts of the network that may touch each other, and those that contact keeps an eye on, kept from step to step.
#pragma once

#include "collision/element_bvh/element_bvh.h"
#include "collision/pairs/neighbour_list_counts.h"
#include "collision/pairs/pair_builder.h"
#include "collision/pairs/proximity_search.h"
#include "collision/surface/feature_edges.h"

#include <vector>

namespace sprung {

/// Each particle has a ball that moves on with it. What is not listed cannot touch, or come within contact's reach, while particles
/// are in their balls; for those that leave theirs, pairs and candidates are looked for again. All balls are made again after as
/// many steps as they were to last, and when particles begin to move so that they had better last less.
class NeighbourList {
 public:
  /// See ProximitySearch. Keeps a reference to the surface.
  NeighbourList(const CollisionSurface& surface, const Points& rest, double margin);
  NeighbourList(const NeighbourList&) = delete;
  NeighbourList& operator=(const NeighbourList&) = delete;

  /// Lists what may touch in a step from `before` to about `after` [m], 3 x n.
  void begin_step(const Points& before, const Points& after);

  /// The next step does not begin where the last one ended: it lists all anew.
  void forget() { horizon_ = 0.0; }

  /// Lists what may touch in a part of the step, as one of its own, but no candidates: the next step lists all anew.
  void begin_part(const Points& before, const Points& after);

  /// Lists what may touch when particles end the step at `ends` [m] instead, where their balls do not hold them there. Requires
  /// begin_step() with the same `before`.
  void follow(const Points& before, const Points& ends);

  /// The normals may be changed.
  [[nodiscard]] std::vector<ContactStencil>& pairs() { return pairs_; }
  /// Contact notes in them what it found.
  [[nodiscard]] std::vector<ContactCandidate>& candidates() { return candidates_; }
  [[nodiscard]] const VertexBounds& balls() const { return balls_; }
  [[nodiscard]] const SurfaceTopology& features() const { return features_; }
  [[nodiscard]] NeighbourListCounts counts() const;

 private:
  [[nodiscard]] double lasting_steps(const Points& before, const Points& after) const;
  [[nodiscard]] std::vector<Index> find_leaving(const Points& ends, double time) const;
  void renew(const std::vector<Index>& leaving, const Points& before, const Points& ends);
  void place_balls(const std::vector<Index>& leaving, const Points& before, const Points& ends);
  /// At those that have a marked particle.
  void look_at_fans();
  void mark_elements();
  void find_pairs(const Points& before);
  void place_leaves(const std::vector<ElementBvh::LeafPair>& pairs, HorizonTimes times);
  [[nodiscard]] bool has_marked(const ContactStencil& pair) const;
  void find_candidates();
  void clear_marks();
  [[nodiscard]] bool is_marked(Index i) const { return marked_[static_cast<std::size_t>(i)] != 0; }

  const CollisionSurface& surface_;
  Points rest_;
  SurfaceTopology features_;
  FeatureEdges sharp_;
  ElementBvh tree_;
  std::vector<LeafBounds> places_;  ///< by leaf, of those looked at last
  VertexBounds balls_;
  PairBuilder pair_search_;
  ProximitySearch contact_search_;
  std::vector<ContactStencil> pairs_;
  std::vector<ContactCandidate> candidates_;
  std::vector<Index> watched_;         ///< particles of bodies that may meet something
  std::vector<Index> watched_bodies_;  ///< theirs
  std::vector<char> flat_;             ///< by particle: see fan_stays_flat()
  double age_ = 0.0;                   ///< of the first balls, in steps
  double horizon_ = 0.0;               ///< age at which all are made again
  Index renewed_ = 0;
  std::vector<char> marked_;  ///< by particle; 0 between calls, as the marks of elements
  std::vector<Index> marked_list_;
  std::vector<Index> moved_on_;  ///< whose balls were made again since candidates were looked for
  std::vector<Index> marked_elements_;
  std::vector<char> is_marked_element_;  ///< 0 between calls
  std::vector<char> visited_;            ///< by particle; 0 between calls
};

}  // namespace sprung
