// Components of free particles that limited springs join: a global solve handles one at a time.
#pragma once

#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Particles joined through free ones; pins separate components. Points are numbered from 0: first the free ones, each before the
/// one it hangs on (the order of elimination), then the pinned ones.
struct StretchComponent {
  struct Link {
    Index first;   ///< a free point
    Index second;  ///< a point of higher number, free or pinned
    double rest_length;
    Index spring;  ///< of the network; kNone between points of a coarse cloth
  };

  std::vector<Index> points;    ///< their particles
  Index free_count = 0;         ///< of points
  std::vector<double> masses;   ///< of free points [kg]
  std::vector<Link> links;      ///< in the order of their first points
  std::vector<Index> begin{0};  ///< links whose first point is the free point i are [begin[i], begin[i + 1])
  bool is_tree = false;         ///< each free point is the first of at most one link to a free point: chains and trees
  bool is_elastic = false;      ///< springs or angle bends with stiffness act on free points

  [[nodiscard]] bool is_free(Index point) const { return point < free_count; }
  [[nodiscard]] Index pin_count() const { return static_cast<Index>(points.size()) - free_count; }
};

/// The components of the springs of the given kinds, ordered by their lowest free particles. A tree is ordered from its leaves to
/// a particle linked to a pin, if there is one.
[[nodiscard]] std::vector<StretchComponent> stretch_components(const SpringNetwork& network, const std::vector<SpringKind>& kinds);

}  // namespace sprung
