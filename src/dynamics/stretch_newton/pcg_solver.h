// Preconditioned conjugate gradients for cloths and solids.
#pragma once

#include "dynamics/numerics/block_cholesky.h"
#include "dynamics/stretch_newton/stretch_system.h"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

namespace sprung {

/// Conjugate gradients in double precision, preconditioned by a factor in single precision. The factor is made for each system, or
/// kept from the previous one if the systems are alike and few iterations suffice. Solutions therefore depend on earlier systems
/// in their last digits; the same sequence of systems gives the same bits. Where single precision sees a singular matrix, the
/// factor's diagonal is raised slightly above rounding; if that fails, the factor is in double precision.
class PcgSolver final : public StretchSystemSolver {
 public:
  /// Keeps a reference to the component.
  explicit PcgSolver(const StretchComponent& component);
  double solve(const StretchSystem& system, Points& step) override;
  void solve_again(const StretchSystem& system, Points& step) override;
  void forget() override;
  void save(ByteWriter& to) const override;
  void load(BinaryReader& from) override;

 private:
  enum class Kept : std::uint8_t { nothing, rough, exact };

  /// The end of conjugate gradients.
  struct Patience {
    int most_iterations;
    double slowest;            ///< largest ratio of the remaining error between two iterations
    double may_be_left = 0.0;  ///< remaining error that is always accepted [kg m^2]
  };

  /// A factor in single precision.
  struct Attempt {
    double raise;  ///< of the diagonal, as in BlockCholesky
    Patience patience;
    double bearable = std::numeric_limits<double>::infinity();  ///< systems stiffer than this skip the attempt
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
  std::unique_ptr<BlockCholesky<double>> exact_;  ///< made when it was needed
  Kept kept_ = Kept::nothing;                     ///< the factor of this system or of the previous one
  std::array<Attempt, 2> attempts_;
  bool last_factor_failed_ = false;  ///< the kept factor failed on a system like this one

  // Scratch of conjugate gradients, 3 x free.
  Points residual_;
  Points preconditioned_;
  Points direction_;
  Points product_;
};

}  // namespace sprung
