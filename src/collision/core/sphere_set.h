// Balls side by side, one for each particle of a patch: which of the particles are outside of theirs.
#pragma once

#include "base/simd.h"
#include "base/types.h"

#include <vector>

namespace sprung {

/// Particles by their columns of `positions` [m], 3 x n, and the way into the frame that the balls are in.
struct SphereVertices {
  const Points& positions;
  const std::vector<Index>& particles;
  const RigidTransform& into;
};

class SphereSet {
 public:
  /// None of them holds anything yet.
  explicit SphereSet(std::size_t count) : blocks_((count + kSimdWidth - 1) / kSimdWidth) {}

  /// One of at most no radius [m] holds nothing.
  void set(Index ball, const Vector3& centre, double radius);

  [[nodiscard]] double radius(Index ball) const { return block(ball).radius[lane(ball)]; }

  /// Replaces `outside` by the balls, ascending, whose particle is not in them, or not `margin` [m] >= 0 from their surface.
  /// Requires as many particles as balls.
  void find_outside(const SphereVertices& asked, double margin, std::vector<Index>& outside) const;

 private:
  struct alignas(64) Block {
    Vector3x4 centre{};
    Double4 radius{};
  };

  [[nodiscard]] const Block& block(Index ball) const { return blocks_[static_cast<std::size_t>(ball) / kSimdWidth]; }
  [[nodiscard]] static int lane(Index ball) { return ball % kSimdWidth; }

  std::vector<Block> blocks_;
};

}  // namespace sprung
