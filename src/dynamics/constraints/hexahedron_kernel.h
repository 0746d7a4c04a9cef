// The volumes of hexahedra, eight at a time. Internal to dynamics/constraints/.
#pragma once

#include "base/types.h"
#include "network/model/cells.h"

#include <array>
#include <cstddef>
#include <span>

namespace sprung {

inline constexpr std::size_t kHexahedraPerGroup = 8;

/// Hexahedra that share no particle.
struct HexahedronGroup {
  template <class Number>
  using OfEach = std::array<Number, kHexahedraPerGroup>;

  std::array<OfEach<Index>, kCornersOfHexahedron> particles;  ///< by corner
  std::array<OfEach<double>, kCornersOfHexahedron> watched;  ///< volume of the part at a corner below which it is watched [m^3 / 6]
  OfEach<double> volume;                                     ///< sum of the parts at rest [m^3 / 6]
  OfEach<std::size_t> number;                                ///< of the hexahedron
};

struct HexahedraVolumes {
  HexahedronGroup::OfEach<double> total;  ///< sum of the parts [m^3 / 6]
  HexahedronGroup::OfEach<double> least;  ///< of the smallest part at a corner [m^3 / 6]
};

/// What a pass found in a group.
struct HexahedraFound {
  HexahedraVolumes volumes;
  HexahedronGroup::OfEach<double> slack;  ///< least difference between a part at a corner and `watched` [m^3 / 6]
};

/// Moves the corners of each hexahedron along the gradients of its volume, in proportion to their inverse masses, so that it has
/// its volume at rest to first order. Writes what it found before the move, an entry a group. The operations and their order are
/// those of CellVolume for a single region, so that the bits are the same.
void project_hexahedra(std::span<const HexahedronGroup> groups, const double* inverse_masses, double* positions,
                       HexahedraFound* found);

/// Writes an entry a group.
void measure_hexahedra(std::span<const HexahedronGroup> groups, const double* positions, HexahedraVolumes* found);

}  // namespace sprung
