// The force of the air on faces.
#pragma once

#include "base/types.h"
#include "dynamics/air/surface_drag.h"
#include "dynamics/air/wind.h"
#include "dynamics/forces/force.h"

#include <string>
#include <vector>

namespace sprung {

struct SpringNetwork;

/// Each triangle of a body's surface feels the air that flows across it and along it. Its area is A, its unit normal n, and u is
/// the velocity of the air minus its own, both as means of its corners. With u_n = n (n . u) and u_t = u - u_n the force is A
/// (normal u_n + tangential u_t), or A (normal |u_n| u_n + tangential |u_t| u_t) if the drag is quadratic, a third of it at each
/// corner.
///
/// Quadratic drag damps the faster, the faster the air: no step of an explicit scheme would be small enough for all speeds. The
/// step therefore counts its rate at the speed that is to be expected: that of the wind plus that at which the body would fall
/// broadside, sqrt(m g / (A c)) with the larger coefficient c. Where the rate dF/du exceeds that and a quarter of 1 / step too, the
/// force is continued linearly.
class SurfaceAirForce final : public Force {
 public:
  /// `gravity` [m/s^2] and the wind give the expected speed. `step` [s] is that of an explicit scheme; 0: the force is quadratic at
  /// any speed, for implicit schemes. Keeps a reference to the network.
  SurfaceAirForce(const SpringNetwork& network, const SurfaceDrag& drag, Wind wind, double gravity, double step);

  void set_step(double dt) override {
    if (step_ > 0.0) step_ = dt;
  }

  /// Takes over the wind. Quadratic drag keeps the expected speed of the constructor.
  void follow(const Conditions& conditions) override { wind_ = conditions.wind; }

  [[nodiscard]] std::string name() const override { return "air on faces"; }
  void add(const Kinematics& at, Points& forces) const override;
  void couple(std::vector<ParticlePair>& pairs) const override;

  /// The derivatives by velocity. Those by position, of areas, normals and gusts, are left out: they are not symmetric.
  void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const override;

  /// Dampers up to the expected speed, with areas as at rest.
  void append_elements(std::vector<LinearElement>& elements) const override;

  /// An upper bound of the acceleration [m/s^2] of particles at rest, with areas as at rest.
  [[nodiscard]] double largest_acceleration() const;

 private:
  struct Face {
    Eigen::Array3i corners;   ///< particles of the network
    double rest_area = 0.0;   ///< [m^2]
    double expected = 0.0;    ///< dF/du by area at the expected speed [kg/(m^2 s)]
    double rate_share = 0.0;  ///< the rate [1/s] of the face by its dF/du [kg/s]; see the constructor
  };
  struct Air;
  struct Flow;
  void list_faces_of_particles();
  [[nodiscard]] Air air_at(const Kinematics& at) const;
  [[nodiscard]] Flow flow(const Face& face, const Kinematics& at, const Air& air) const;

  const SpringNetwork& network_;
  SurfaceDrag drag_;
  Wind wind_;
  double step_;
  std::vector<Face> faces_;         ///< without those that have no area at rest
  std::vector<Index> first_entry_;  ///< by particle, in faces_at_
  std::vector<Index> faces_at_;     ///< the faces of each particle, ascending
};

}  // namespace sprung
