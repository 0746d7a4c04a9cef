// Spheres in SIMD lanes, one for each particle of a patch: finds the particles outside of their spheres.
#pragma once

#include "base/files/binary_archive.h"
#include "base/machine/simd.h"
#include "base/types.h"

#include <vector>

namespace sprung {

/// Particles by their columns of `positions` [m], 3 x n, and the transform into the frame of the spheres.
struct SphereVertices {
  const Points& positions;
  const std::vector<Index>& particles;
  const RigidTransform& into;
};

class SphereSet {
 public:
  /// All spheres are empty at first.
  explicit SphereSet(std::size_t count) : blocks_((count + kSimdWidth - 1) / kSimdWidth) {}

  /// A sphere with a radius [m] of 0 or less is empty.
  void set(Index sphere, const Vector3& centre, double radius);

  [[nodiscard]] double radius(Index sphere) const { return block(sphere).radius[lane(sphere)]; }

  /// Replaces `outside` by the numbers of the spheres, ascending, whose particle is not inside, at least `margin` [m] >= 0 below
  /// the surface. Requires one particle per sphere.
  void find_outside(const SphereVertices& asked, double margin, std::vector<Index>& outside) const;

 private:
  struct alignas(64) Block {
    Vector3x4 centre{};
    Double4 radius{};
  };

  template <Same<Block> S, class Visit>
  friend void visit_members(S& b, const Visit& visit) {
    visit(b.centre.x, b.centre.y, b.centre.z, b.radius);
  }
  template <Same<SphereSet> S, class Visit>
  friend void visit_members(S& s, const Visit& visit) {
    visit(fixed_size(s.blocks_));
  }

  [[nodiscard]] const Block& block(Index sphere) const { return blocks_[static_cast<std::size_t>(sphere) / kSimdWidth]; }
  [[nodiscard]] static int lane(Index sphere) { return sphere % kSimdWidth; }

  std::vector<Block> blocks_;
};

}  // namespace sprung
