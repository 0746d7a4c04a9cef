// Newton's method for the stretch limit of a large cloth on two levels.
#pragma once

#include "dynamics/stretch_newton/coarse_cloth.h"
#include "dynamics/stretch_newton/component_newton.h"

#include <memory>
#include <vector>

namespace sprung {

/// Solves for a coarse cloth of about every other row and column and interpolates its correction to the fine one, as in multigrid
/// methods (Brandt 1977). The coarse cloth moves as the fine particles do on average and is brought within the limit. The fine
/// motion relative to it continues where links around it are slack; where they pull, it is damped as by an implicit step, and
/// unevenness is straightened. Passes remove the small excess that fine links keep.
/// A factor of a quarter of the particles takes a seventh of the time or less.
class TwoLevelNewton final : public ComponentSolver {
 public:
  /// For the component that the coarse cloth was made from.
  TwoLevelNewton(const StretchComponent& component, CoarseCloth coarse, const StretchLimitSettings& settings);

  std::optional<int> solve(const Points& before, Points& positions, double steady_displacement) override;
  void forget() override { newton_.forget(); }
  void save(ByteWriter& to) const override { newton_.save(to); }
  void load(BinaryReader& from) override { newton_.load(from); }
  [[nodiscard]] double deformation() const override { return newton_.deformation(); }

 private:
  void gather(const Points& before, const Points& positions);
  void note_tautness();
  void interpolate_correction(double steady_displacement);
  void stay_still();
  void keep_momentum();
  [[nodiscard]] bool rests() const;
  [[nodiscard]] Vector3 common_move() const;

  CoarseCloth coarse_;
  std::vector<Index> particles_;       ///< the cloth's free particles, of the network
  std::vector<double> masses_;         ///< of these particles [kg]
  std::vector<double> coarse_masses_;  ///< by coarse point; 1 of pins
  bool flies_;                         ///< nothing is pinned
  ComponentNewton newton_;             ///< of the coarse cloth

  // Of a solve, 3 x free particles: the beginning of the step, the target of the forces, and the result.
  Points before_;
  Points target_;
  Points x_;
  // The same for coarse points.
  Points coarse_before_;
  Points coarse_target_;
  Points coarse_x_;
  std::vector<double> tautness_;  ///< by coarse point: stiffness of its pulling links across their directions [kg]
};

/// Chooses the solver of a component: two levels for a cloth from make_cloth without stiffness, with at least 8,192 free
/// particles, that collides with nothing; otherwise one level.
[[nodiscard]] std::unique_ptr<ComponentSolver> make_component_solver(const SpringNetwork& network, StretchComponent component,
                                                                     const StretchLimitSettings& settings, const LimitUse& use);

}  // namespace sprung
