// Sparse factors for cloths and solids.
#pragma once

#include "dynamics/block_cholesky.h"
#include "dynamics/stretch_system.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

namespace sprung {

/// Conjugate gradients in double precision, with a factor in single precision as preconditioner: a new one for each system, or the
/// last one for a system that is like the one before, where few iterations come near enough. So solutions depend on the systems
/// before, in their later digits; the same systems one after the other have the same bits. What single precision cannot tell from
/// singular is solved by a factor in double precision.
class SparseSolver final : public StretchSystemSolver {
 public:
  /// Keeps a reference to the component.
  explicit SparseSolver(const StretchComponent& component);
  double solve(const StretchSystem& system, Points& step) override;

 private:
  enum class Kept : std::uint8_t { nothing, rough, exact };

  void assemble(const StretchSystem& system);
  [[nodiscard]] std::optional<double> approach_as_last(const Points& right, Points& step);
  template <class Factor>
  [[nodiscard]] std::optional<double> approach(Factor& factor, const Points& right, Points& step);
  void keep_momentum(const Points& right, Points& step) const;
  void solve_exactly(const Points& right, Points& step);
  [[nodiscard]] double stiffest() const;
  [[nodiscard]] double largest_size() const;

  const StretchComponent& component_;
  BlockMatrix matrix_;  ///< M + K
  BlockCholesky<float> rough_;
  std::unique_ptr<BlockCholesky<double>> exact_;               ///< once it was needed
  Kept kept_ = Kept::nothing;                                  ///< the factor of this system or of the last
  double bearable_ = std::numeric_limits<double>::infinity();  ///< what is less stiff is tried in single precision

  // Of conjugate gradients, 3 x free.
  Points left_;
  Points towards_;
  Points direction_;
  Points pushed_;
};

}  // namespace sprung
