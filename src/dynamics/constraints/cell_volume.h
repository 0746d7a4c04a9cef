// Keeps the volume of the cells of solids.
#pragma once

#include "dynamics/constraints/colouring.h"
#include "dynamics/constraints/constraint.h"
#include "dynamics/constraints/hexahedron_kernel.h"
#include "network/model/spring_network.h"

#include <array>
#include <span>
#include <vector>

namespace sprung {

/// Keeps the volume of each hexahedron and, of tetrahedra, the volume around each particle: one condition per tetrahedron would
/// leave a mesh no freedom to bend (volumetric locking; Bonet and Burton 1998 average over particles for this reason). No
/// tetrahedron, and none at the corner of a hexahedron, may shrink below a tenth of its volume at rest, so that no cell turns
/// inside out.
class CellVolume final : public Constraint {
 public:
  /// Of all bodies whose volume is kept (Body::preserve_volume), which are at rest at the positions of the network. Keeps a
  /// reference to the network.
  explicit CellVolume(const SpringNetwork& network);

  double project(const Points& before, Points& positions, const ImpulseRecorder& recorder) const override;

  /// A volume may differ by 1 % from that at rest, and nothing may be inside out, which counts as 100.
  [[nodiscard]] double residual(const Points& positions) const override;

 private:
  using Corners = std::array<std::uint8_t, 4>;  ///< of a tetrahedron, as numbers of the region's particles

  /// A tetrahedron within a region.
  struct Part {
    Corners corners;
    double least;  ///< the least volume that it may have [m^3 / 6]; minus infinity if it may have any
  };

  /// Tetrahedra whose total volume is kept.
  struct Region {
    std::span<const Index> particles;
    std::span<const Part> parts;
    double volume;  ///< sum of the parts at rest [m^3 / 6], > 0
  };

  void add_hexahedra(const Body& body);
  void add_stars(const Body& body);
  /// The first `upright` parts may not turn inside out.
  void add(const std::vector<Index>& particles, const std::vector<Corners>& parts, std::size_t upright);
  [[nodiscard]] Region region(std::size_t number) const;
  [[nodiscard]] static bool is_inverted(const Part& part, double volume);
  void make_groups(const Colouring& colouring, std::size_t hexahedra);
  [[nodiscard]] HexahedronGroup group_of(const std::vector<std::size_t>& hexahedra) const;
  void project_groups(std::size_t begin, std::size_t end, Points& positions, std::vector<double>& changes,
                      const ImpulseRecorder& recorder) const;
  [[nodiscard]] bool has_pinned(const HexahedronGroup& group) const;
  double project(const Region& region, Points& positions, const ImpulseRecorder& recorder) const;
  [[nodiscard]] static double change(const Region& region, const Points& positions);
  void project_parts(const Region& region, Points& positions, const ImpulseRecorder& recorder) const;

  const SpringNetwork& network_;

  // Region r has the particles [particles_begin_[r], particles_begin_[r + 1]), and so on.
  std::vector<std::size_t> particles_begin_{0};
  std::vector<std::size_t> parts_begin_{0};
  std::vector<Index> particles_;
  std::vector<Part> parts_;
  std::vector<double> volumes_;

  // Of each colour: groups of hexahedra, and the regions that are in none, which are projected one by one.
  std::vector<HexahedronGroup> groups_;
  std::vector<std::size_t> groups_begin_{0};
  std::vector<std::size_t> singles_;
  std::vector<std::size_t> singles_begin_{0};
};

}  // namespace sprung
