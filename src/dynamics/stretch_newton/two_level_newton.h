// Newton's method for the stretch limit of a large cloth: of every other row and column, which lead the rest along.
#pragma once

#include "dynamics/stretch_newton/coarse_cloth.h"
#include "dynamics/stretch_newton/component_newton.h"

#include <memory>
#include <vector>

namespace sprung {

/// A coarse cloth goes as the fine one's particles go on average, is brought within the limit by itself, and takes the fine one
/// along by as much as its limit led it: a correction on a coarser level, as in multigrid methods (Brandt 1977). What particles do
/// beside that goes on where links around them are slack; where they pull it dies out as an implicit step has it, and what is
/// uneven is straightened. The little that fine links are too long then is left to passes.
///
/// A factor of a quarter of the particles takes a seventh of the time or less.
class TwoLevelNewton final : public ComponentSolver {
 public:
  /// Of the component that the coarse cloth was made of.
  TwoLevelNewton(const StretchComponent& component, CoarseCloth coarse, const StretchLimitSettings& settings);

  std::optional<int> solve(const Points& before, Points& positions, double fall) override;
  [[nodiscard]] double turn() const override { return newton_.turn(); }

 private:
  void gather(const Points& before, const Points& positions);
  void note_tautness();
  void lead_along(double fall);
  void stay_still();
  void keep_momentum();
  [[nodiscard]] bool rests() const;
  [[nodiscard]] Vector3 common_move() const;

  CoarseCloth coarse_;
  std::vector<Index> particles_;       ///< the cloth's free ones, of the network
  std::vector<double> masses_;         ///< of them [kg]
  std::vector<double> coarse_masses_;  ///< by coarse point; 1 of pins
  bool flies_;                         ///< nothing is pinned
  ComponentNewton newton_;             ///< of the coarse cloth

  // Of a solve, 3 x free particles: where the step began, where forces led, and where the solve does.
  Points before_;
  Points led_;
  Points x_;
  // The same of coarse points.
  Points coarse_before_;
  Points coarse_led_;
  Points coarse_x_;
  std::vector<double> tautness_;  ///< by coarse point: how stiff the pull of its links is across them [kg]
};

/// What solves for a component: two levels for cloths from make_cloth without stiffness, of 8,192 free particles and more, that
/// meet nothing and whose limit has a tolerance of half a per cent or more; else one.
[[nodiscard]] std::unique_ptr<ComponentSolver> make_component_solver(const SpringNetwork& network, StretchComponent component,
                                                                     const StretchLimitSettings& settings, const LimitUse& use);

}  // namespace sprung
