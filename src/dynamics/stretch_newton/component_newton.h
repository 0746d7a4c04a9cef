// Newton's method for the stretch limit of one component.
#pragma once

#include "dynamics/state/recorded_impulses.h"
#include "dynamics/stretch_newton/coarse_tree.h"
#include "dynamics/stretch_newton/component_solver.h"
#include "dynamics/stretch_newton/stretch_energy.h"
#include "dynamics/stretch_newton/stretch_system.h"

#include <limits>
#include <memory>
#include <optional>

namespace sprung {

/// Minimises StretchEnergy by Newton's method with a backtracking line search. Iterations on a tree that moves by many links in a
/// step would bring a bend on by a link or two each, and stop far from the minimum. Trees therefore begin at the minimum of a
/// coarse tree, which is found in the same way (nested iteration, Hackbusch 1985, chapter 5).
class ComponentNewton final : public ComponentSolver {
 public:
  ComponentNewton(StretchComponent component, const StretchLimitSettings& settings);
  ~ComponentNewton() override;
  ComponentNewton(const ComponentNewton&) = delete;
  ComponentNewton& operator=(const ComponentNewton&) = delete;

  /// Solves to the minimum. Links are stiff enough to carry the component against `steady_displacement` and its own motion. In a
  /// chain or tree that hangs on one link, no link exceeds the tolerance afterwards.
  std::optional<int> solve(const Points& before, Points& positions, double steady_displacement) override;

  void forget() override;
  void save(ByteWriter& to) const override;
  void load(BinaryReader& from) override;

  /// Sets the rods of the next solve, by number. Keeps a reference to them. Required if the component has rods.
  void set_rods(std::span<const RodRow> rows);

  /// Records the impulses of the last solve, which gave positions, and adds those of rods to `pushes`, by number [kg m].
  void record(const ImpulseRecorder& recorder, std::vector<Vector3>& pushes) const;

  [[nodiscard]] double deformation() const override;

  /// Each link's stiffness across its direction at the end of the last solve [kg]; 0 for slack links.
  [[nodiscard]] std::vector<double> stiffness_across() const { return energy_.stiffness_across(x_); }

 private:
  /// The fraction of a step that was taken, and whether it was corrected for links that it rotated.
  struct Descent {
    double fraction;
    bool corrected;
  };

  void gather(const Points& before, const Points& positions);
  [[nodiscard]] Vector3 common_move() const;
  [[nodiscard]] double link_load(double steady_displacement) const;
  [[nodiscard]] double most_beyond() const;
  void set_initial_iterate();
  void write_to(Points& positions) const;
  int minimise(double energy_at_target, double steady_displacement);
  [[nodiscard]] double start(double energy_at_target);
  void note_balance(double energy);
  [[nodiscard]] bool is_at_rest() const;
  [[nodiscard]] double target_shift() const;
  [[nodiscard]] double inertia() const;
  [[nodiscard]] double imbalance() const;
  [[nodiscard]] Descent descend(double& energy, double forecast);
  [[nodiscard]] double correct(double reached);
  bool leap(double& energy, double steady_displacement);
  void clip();

  StretchComponent component_;
  StretchLimitSettings settings_;
  StretchEnergy energy_;
  std::span<const RodRow> rows_;
  std::unique_ptr<StretchSystemSolver> solver_;  ///< made by the first solve
  std::unique_ptr<CoarseTree> coarse_;           ///< made when it was needed
  std::unique_ptr<ComponentNewton> on_coarse_;   ///< solves for coarse_; remembers nothing between solves
  bool clips_;
  int last_iterations_ = std::numeric_limits<int>::max();             ///< of the previous solve, if any
  double mass_ = 0.0;                                                 ///< of all free points [kg]
  double balanced_energy_ = std::numeric_limits<double>::infinity();  ///< where the component came to rest, while it rests [kg m^2]
  Points balanced_;                                                   ///< positions at rest, 3 x points
  Points balanced_target_;                                            ///< the target of the forces when it came to rest

  Vector3 common_move_ = Vector3::Zero();  ///< of the last solve [m]
  double farthest_squared_ = 0.0;          ///< largest displacement of a point by forces, minus the common displacement [m^2]
  double extent_ = 0.0;                    ///< of the component at the beginning of the step [m]

  // Of a solve, 3 x points: the beginning of the step, the target of the forces, and the current iterate.
  Points before_;
  Points target_;
  Points x_;
  Points tried_;
  Points step_;
  Points correction_;
  Points corrected_;
  StretchSystem system_;
  StretchSystem tried_system_;
};

}  // namespace sprung
