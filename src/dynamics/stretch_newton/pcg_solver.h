// Sparse factors for cloths and solids.
#pragma once

#include "dynamics/numerics/block_cholesky.h"
#include "dynamics/stretch_newton/stretch_system.h"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

namespace sprung {

/// Conjugate gradients in double precision, with a factor in single precision as preconditioner: a new one for each system, or the
/// last one for a system that is like the one before, where few iterations come near enough. So solutions depend on the systems
/// before, in their later digits; the same systems one after the other have the same bits. What single precision cannot tell from
/// singular has its diagonal raised for the factor, a little above its rounding, and if that does not do, a factor in double
/// precision.
class PcgSolver final : public StretchSystemSolver {
 public:
  /// Keeps a reference to the component.
  explicit PcgSolver(const StretchComponent& component);
  double solve(const StretchSystem& system, Points& step) override;
  void solve_again(const StretchSystem& system, Points& step) override;

 private:
  enum class Kept : std::uint8_t { nothing, rough, exact };

  /// How long conjugate gradients go on.
  struct Patience {
    int most_iterations;
    double slowest;            ///< what may be left by an iteration of what was there before it
    double may_be_left = 0.0;  ///< when it is surely near enough [kg m^2]
  };

  /// A factor in single precision.
  struct Roughly {
    double raise;  ///< of the diagonal, as BlockCholesky has it
    Patience patience;
    double bearable = std::numeric_limits<double>::infinity();  ///< what is less stiff is tried so
  };

  void assemble(const StretchSystem& system);
  [[nodiscard]] std::optional<double> solve_as_last(const StretchSystem& system, Points& step);
  void solve_with_kept(const Points& right, Points& solution);
  [[nodiscard]] std::optional<double> approach_with_kept(const Patience& patience, const Points& right, Points& step);
  [[nodiscard]] std::optional<double> approach(const Patience& patience, const Points& right, Points& step);
  void keep_momentum(const Points& right, Points& step) const;
  void solve_exactly(const Points& right, Points& step);
  [[nodiscard]] double stiffest() const;
  [[nodiscard]] double largest_size() const;

  const StretchComponent& component_;
  BlockMatrix matrix_;  ///< M + K
  BlockCholesky<float> rough_;
  std::unique_ptr<BlockCholesky<double>> exact_;  ///< once it was needed
  Kept kept_ = Kept::nothing;                     ///< the factor of this system or of the last
  std::array<Roughly, 2> ways_;
  bool led_nowhere_ = false;  ///< the factor of a system that was much like this one

  // Of conjugate gradients, 3 x free.
  Points left_;
  Points towards_;
  Points direction_;
  Points pushed_;
};

}  // namespace sprung
