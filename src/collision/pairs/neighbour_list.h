// Neighbour list: element pairs that may touch and contact candidates, kept from step to step (Verlet 1967).
#pragma once

#include "collision/element_bvh/element_bvh.h"
#include "collision/pairs/pair_builder.h"
#include "collision/pairs/proximity_search.h"
#include "collision/surface/surface_topology.h"

#include <vector>

namespace sprung {

/// Each particle has a moving sphere. Elements that are not listed cannot touch, or come within contact's reach, while all
/// particles are in their spheres. If particles leave their spheres, the list is renewed around them. The whole list is renewed at
/// its horizon, and earlier if the motion has changed so that a much shorter horizon pays.
class NeighbourList {
 public:
  /// See ProximitySearch for the arguments. Keeps a reference to the surface.
  NeighbourList(const CollisionSurface& surface, const Points& rest, double margin);
  NeighbourList(const NeighbourList&) = delete;
  NeighbourList& operator=(const NeighbourList&) = delete;

  /// Lists what may touch in a step from `before` [m], 3 x n, to expected positions `after`.
  void begin_step(const Points& before, const Points& after);

  /// Discards the list. Call it if the next step does not begin where the last one ended.
  void forget() { horizon_ = 0.0; }

  /// Lists the pairs of a substep as if it were a step, but no candidates. Discards the list for the steps that follow.
  void begin_substep(const Points& before, const Points& after);

  /// Adds the pairs that may touch if the step ends at `ends` [m] instead: renews the list around particles that leave their
  /// spheres. Requires begin_step() or begin_substep() with the same `before`.
  void follow(const Points& before, const Points& ends);

  /// The caller may change their normals.
  [[nodiscard]] std::vector<ContactStencil>& pairs() { return pairs_; }
  /// The caller may change their normals and the steps that may skip them.
  [[nodiscard]] std::vector<ContactCandidate>& candidates() { return candidates_; }
  [[nodiscard]] const VertexBounds& spheres() const { return spheres_; }
  [[nodiscard]] const SurfaceTopology& topology() const { return topology_; }

 private:
  /// What stays from step to step.
  template <Same<NeighbourList> S, class Visit>
  friend void visit_members(S& l, const Visit& visit) {
    visit(l.feature_edges_, l.tree_, l.spheres_, l.pairs_, l.candidates_, fixed_size(l.flat_), l.age_, l.horizon_, l.renewed_);
  }

  [[nodiscard]] double best_horizon(const Points& before, const Points& after) const;
  [[nodiscard]] std::vector<Index> find_leaving(const Points& ends, double time) const;
  void renew(const std::vector<Index>& leaving, const Points& before, const Points& ends);
  void reset_spheres(const std::vector<Index>& leaving, const Points& before, const Points& ends);
  /// Updates `flat_` for all fans with a marked particle.
  void test_fans();
  void mark_elements();
  void find_pairs(const Points& before);
  [[nodiscard]] bool has_marked(const ContactStencil& stencil) const;
  void find_candidates();
  void clear_marks();
  [[nodiscard]] bool is_marked(Index i) const { return marked_[static_cast<std::size_t>(i)] != 0; }

  const CollisionSurface& surface_;
  Points rest_;
  SurfaceTopology topology_;
  FeatureEdges feature_edges_;
  ElementBvh tree_;
  std::vector<LeafCorners> corners_;  ///< by leaf; up to date for the leaves of the last search
  VertexBounds spheres_;
  PairBuilder pair_builder_;
  ProximitySearch proximity_search_;
  std::vector<ContactStencil> pairs_;
  std::vector<ContactCandidate> candidates_;
  std::vector<Index> watched_;         ///< particles of bodies that collide
  std::vector<Index> watched_bodies_;  ///< their bodies
  std::vector<char> flat_;             ///< by particle: results of fan_stays_flat()
  double age_ = 0.0;                   ///< since the whole list was renewed [steps]
  double horizon_ = 0.0;               ///< age at which the whole list is renewed [steps]
  std::vector<char> marked_;           ///< by particle; 0 between calls
  std::vector<Index> marked_list_;
  std::vector<Index> renewed_;  ///< particles whose spheres were reset since the last search for candidates
  std::vector<Index> marked_elements_;
  std::vector<char> is_marked_element_;  ///< by element; 0 between calls
  std::vector<char> visited_;            ///< by particle; 0 between calls
};

}  // namespace sprung
