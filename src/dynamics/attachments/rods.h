// Rods: links that keep their length.
#pragma once

#include "dynamics/attachments/link_ends.h"
#include "dynamics/constraints/colouring.h"
#include "dynamics/constraints/constraint.h"
#include "dynamics/constraints/rod_row.h"

#include <vector>

namespace sprung {

/// The time in which a rod that engages at another distance than its length comes to its length, as by a winch: a rod that did so
/// in a step would throw its ends [s].
inline constexpr double kWinchTime = 0.25;

/// The length of a rod at a time [m]: from the distance at which it engaged to its length, smoothly within kWinchTime.
[[nodiscard]] double length_at(const Link& link, double time);

/// Keeps the distance between the ends of rigid links. Particles move along the line that joined the ends when the step began
/// (SHAKE: Ryckaert, Ciccotti and Berendsen 1977), so that schemes keep the angular momentum, and Verlet the energy of a rod that
/// swings.
class Rods final : public Constraint {
 public:
  /// Keeps references to both.
  Rods(const SpringNetwork& network, const std::vector<Obstacle>& obstacles);

  /// Replaces the rods by the rigid ones of the links that are not broken. Their second ends and lengths are those of `time` [s].
  void load(const std::vector<Link>& links, double time);

  void prepare(double time) override;
  double project(const Points& before, Points& positions, const ImpulseRecorder& recorder) const override;

  /// A length may be off by 0.05 %; that of a rod of length 0 by 0.05 % of the mean spring length.
  [[nodiscard]] double residual(const Points& positions) const override;

  /// The rods of the step that `prepare` began.
  [[nodiscard]] const std::vector<RodRow>& rows() const { return rows_; }

  /// Adds what a solver outside of the passes pushed on the first ends of the rods, as masses times displacements [kg m].
  void add_pushes(const std::vector<Vector3>& pushes);

  /// Adds the impulses of all passes since `prepare`, which began a step of `dt` [s], to the links that `load` got.
  void add_impulses(double dt, std::vector<Link>& links) const;

 private:
  struct Rod {
    std::size_t number;  ///< of the link
    LinkEnds ends;
    Link link;
    double inverse_mass;               ///< [1/kg]
    double length = 0.0;               ///< now [m]
    Vector3 anchor = Vector3::Zero();  ///< now [m]
    double tolerance = 0.0;            ///< [m]
  };
  double project(std::size_t number, const Points& before, Points& positions, const ImpulseRecorder& recorder) const;
  [[nodiscard]] static double violation(const Rod& rod, const Vector3& difference);

  const SpringNetwork& network_;
  const std::vector<Obstacle>& obstacles_;
  double joint_tolerance_;  ///< of rods of length 0 [m]
  std::vector<Rod> rods_;
  std::vector<RodRow> rows_;
  Colouring colouring_;
  mutable std::vector<Vector3> pushes_;  ///< of the passes since `prepare`, as masses times displacements [kg m]
};

}  // namespace sprung
