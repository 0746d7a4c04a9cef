// Components of free particles that limited springs join: a global solve handles one at a time.
#pragma once

#include "dynamics/constraints/rod_row.h"
#include "network/model/spring_network.h"

#include <array>
#include <span>
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

  /// A rod with a free point. The row of its number has the weights of its points, and its length.
  struct Rod {
    std::size_t number;
    std::array<Index, 4> points;
    std::size_t count;
  };

  std::vector<Index> points;    ///< their particles
  Index free_count = 0;         ///< of points
  std::vector<double> masses;   ///< of free points [kg]
  std::vector<Link> links;      ///< in the order of their first points
  std::vector<Index> begin{0};  ///< links whose first point is the free point i are [begin[i], begin[i + 1])
  std::vector<Rod> rods;        ///< ascending numbers
  double carried_mass = 0.0;    ///< of all bodies that have a point, if there are rods [kg]
  bool is_tree = false;     ///< without rods, and each free point is the first of at most one link to a free point: chains, trees
  bool is_elastic = false;  ///< springs or angle bends with stiffness act on free points

  [[nodiscard]] bool is_free(Index point) const { return point < free_count; }
  [[nodiscard]] Index pin_count() const { return static_cast<Index>(points.size()) - free_count; }
};

/// The components of the springs of the given kinds, ordered by their lowest free particles. A tree is ordered from its leaves to
/// a particle linked to a pin, if there is one.
[[nodiscard]] std::vector<StretchComponent> stretch_components(const SpringNetwork& network, const std::vector<SpringKind>& kinds);

/// The same for the springs of the given numbers. Rods join components; a component of rods alone is left out.
[[nodiscard]] std::vector<StretchComponent> stretch_components(const SpringNetwork& network, const std::vector<Index>& springs,
                                                               std::span<const RodRow> rods);

}  // namespace sprung
