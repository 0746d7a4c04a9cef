// The springs of attachments, and what stands for rods in implicit schemes.
#pragma once

#include "dynamics/attachments/link_ends.h"
#include "dynamics/forces/force.h"

#include <string>
#include <vector>

namespace sprung {

/// The force of a spring-damper (eq. 5-12) between the ends of each link with a stiffness. The velocity of an obstacle's point is
/// its mean velocity over the next step.
///
/// An implicit scheme solves for the forces of all springs at once. If passes alone kept a rod, they would move just the particles
/// at its ends, and the rest of the bodies would not follow. In such a scheme a rod is therefore a spring too, so stiff that its
/// length changes by a thousandth at most. Passes correct the rest.
class AttachmentSprings final : public Force {
 public:
  /// Keeps references to both. `implicit`: whether rods are springs too.
  AttachmentSprings(const SpringNetwork& network, const std::vector<Obstacle>& obstacles, double step_length, bool implicit);

  /// Replaces the springs by those of the links that are not broken.
  void load(const std::vector<Link>& links);

  /// The time of the state for `energy` [s].
  void set_time(double time) { time_ = time; }

  [[nodiscard]] std::string name() const override { return "attachments"; }
  void add(const Kinematics& at, Points& forces) const override;
  void couple(std::vector<ParticlePair>& pairs) const override;
  void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const override;
  /// Of all springs that the network's attachments make at some time. One that engages later is taken to have the second end that
  /// is nearest at time 0, and there the least mass that it may meet.
  void append_elements(std::vector<LinearElement>& elements) const override;
  void note_solution(const Points& positions) override;
  /// Without that of rods.
  [[nodiscard]] double energy(const Points& positions) const override;

  /// The force of a link on its first end [N].
  [[nodiscard]] Vector3 force_of(const Link& link, const Kinematics& at) const;

  /// Adds the impulses of rods in a step of `dt` [s] to the links, by the last solution of an implicit scheme.
  void add_impulses(double dt, std::vector<Link>& links) const;

 private:
  struct Spring {
    std::size_t number;  ///< of the link
    LinkEnds ends;
    Link link;
    double stiffness;  ///< [N/m]
    double damping;    ///< [N s/m]
    bool rigid;
    // Of rods, at the last derivatives.
    mutable Vector3 difference{};  ///< of the ends [m]
    mutable Matrix3 derivative{};  ///< of the force on the first end by it [N/m]
    mutable Vector3 force{};       ///< [N]; after note_solution that of the solution
  };
  void append_elements(std::size_t attachment, std::vector<LinearElement>& elements) const;
  [[nodiscard]] Spring spring_of(std::size_t number, const Link& link) const;
  [[nodiscard]] Vector3 difference_of(const Spring& spring, const Kinematics& at) const;
  [[nodiscard]] double length_of(const Spring& spring, double time) const;
  [[nodiscard]] Vector3 force_of(const Spring& spring, const Kinematics& at) const;
  [[nodiscard]] Matrix3 stiffness_of(const Spring& spring, const Vector3& difference, double length) const;

  const SpringNetwork& network_;
  const std::vector<Obstacle>& obstacles_;
  double step_length_;
  bool implicit_;
  Scalars stiffness_at_;  ///< sum of the stiffnesses of the springs at each particle, for implicit schemes [N/m]
  std::vector<Spring> springs_;
  double time_ = 0.0;
};

}  // namespace sprung
