// Newton's method for the stretch limit of one component.
#pragma once

#include "dynamics/stretch_newton/component_solver.h"
#include "dynamics/stretch_newton/stretch_energy.h"
#include "dynamics/stretch_newton/stretch_system.h"

#include <limits>
#include <memory>
#include <optional>

namespace sprung {

/// Minimises StretchEnergy by Newton's method with a halving line search.
class ComponentNewton final : public ComponentSolver {
 public:
  ComponentNewton(StretchComponent component, const StretchLimitSettings& settings);
  ~ComponentNewton() override;
  ComponentNewton(const ComponentNewton&) = delete;
  ComponentNewton& operator=(const ComponentNewton&) = delete;

  /// To the minimum. Links are made stiff enough to carry the component against `fall`, and against the motion it has. Of a chain
  /// or tree that hangs on one link, no link is beyond the tolerance then.
  std::optional<int> solve(const Points& before, Points& positions, double fall) override;

  [[nodiscard]] double turn() const override;

  /// How stiff each link's pull makes it against turning, where the last solve ended [kg]; 0 of links that do not pull.
  [[nodiscard]] std::vector<double> stiffness_across() const { return energy_.stiffness_across(x_); }

 private:
  /// How much of a step was made, and whether it was bent after links that it turned.
  struct Descent {
    double part;
    bool corrected;
  };

  void gather(const Points& before, const Points& positions);
  [[nodiscard]] Vector3 common_move() const;
  [[nodiscard]] double carried_weight(double fall) const;
  [[nodiscard]] double most_beyond() const;
  void begin_beside_led();
  void write_to(Points& positions) const;
  int minimise(double energy_where_led);
  [[nodiscard]] double start(double energy_where_led);
  void note_balance(double energy);
  [[nodiscard]] bool rests_in_place() const;
  [[nodiscard]] double led_apart() const;
  [[nodiscard]] double inertia() const;
  [[nodiscard]] double imbalance() const;
  [[nodiscard]] Descent descend(double& energy, double forecast);
  [[nodiscard]] double correct(double reached);
  void clip();

  StretchComponent component_;
  StretchLimitSettings settings_;
  StretchEnergy energy_;
  std::unique_ptr<StretchSystemSolver> solver_;  ///< from the first solve on
  bool clips_;
  int last_iterations_ = std::numeric_limits<int>::max();             ///< of the solve before, if there was one
  double mass_ = 0.0;                                                 ///< of all free points [kg]
  double balanced_energy_ = std::numeric_limits<double>::infinity();  ///< of where it came to rest, while it does [kg m^2]
  Points balanced_;                                                   ///< where that is, 3 x points,
  Points balanced_led_;                                               ///< and where forces led from there

  Vector3 common_move_ = Vector3::Zero();  ///< of the last solve [m]
  double farthest_squared_ = 0.0;          ///< that a point was led, apart from the common move [m^2]
  double extent_ = 0.0;                    ///< where the step began [m]

  // Of a solve, 3 x points: where the step began, where forces led, where the solve is.
  Points before_;
  Points led_;
  Points x_;
  Points tried_;
  Points step_;
  Points turn_;
  Points turned_;
  StretchSystem system_;
  StretchSystem tried_system_;
};

}  // namespace sprung
