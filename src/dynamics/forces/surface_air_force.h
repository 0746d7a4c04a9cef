// The force of the air on faces and lines.
#pragma once

#include "base/types.h"
#include "dynamics/air/surface_drag.h"
#include "dynamics/air/wind.h"
#include "dynamics/forces/force.h"
#include "dynamics/forces/surface_air_kernel.h"

#include <string>
#include <vector>

namespace sprung {

struct Body;
struct SpringNetwork;

/// The drag of the air on the faces of bodies, and on the lines of bodies without faces. u is the velocity of the air minus that of
/// the face or line, both as means of its ends; u_n and u_t are its parts across and along. Each end has an equal share of the
/// force.
///
/// A face of area A has the force A (normal u_n + tangential u_t), or A (normal |u_n| u_n + tangential |u_t| u_t) if the drag is
/// quadratic. Its coefficients are those of Body::drag, or of the settings for bodies without a drag of their own. Body::drag is
/// quadratic, with |u_n| + kLowSpeed in place of |u_n|.
///
/// A line of length l of a body that has a diameter d follows the cross-flow principle (Taylor 1952, Hoerner 1965): it has the
/// force 1/2 rho d l (C_n |u_n| u_n + C_t |u_t| u_t). C_n = 1 + 10 Re^(-2/3) with Re = |u_n| d / nu is White's fit for cylinders
/// (Viscous Fluid Flow) up to Re = 2e5. Below Re = 1 it continues, 20 % below Lamb's law at Re = 0.1. C_t = 0.02 is Hoerner's for
/// wires and cables.
///
/// The damping rate of quadratic drag grows with the speed, so that no explicit step is small enough for all speeds. The largest
/// stable step therefore holds for the expected speed. For Body::drag it is that of the wind. For the drag of the settings it is
/// that of the wind plus that at which the body would fall broadside, sqrt(m g / (A c)) with the larger coefficient c. Where the
/// damping rate exceeds both its value at the expected speed and 1 / (4 step), the force is linear. In still air Body::drag thus
/// bounds no step: leapfrog schemes stay stable up to 0.93 of the largest stable step without it.
class SurfaceAirForce final : public Force {
 public:
  /// `drag` is that of the settings. `gravity` [m/s^2], >= 0, and the wind give its expected speed. `step` [s] is that of an
  /// explicit scheme, or 0 for implicit ones, where quadratic drag is never linear. Keeps a reference to the network.
  SurfaceAirForce(const SpringNetwork& network, const SurfaceDrag& drag, Wind wind, double gravity, double step);

  /// Whether it acts on nothing.
  [[nodiscard]] bool is_empty() const { return elements_.empty(); }

  void set_step(double dt) override {
    if (step_ > 0.0) step_ = dt;
  }

  void follow(const Conditions& conditions) override;
  [[nodiscard]] std::string name() const override { return "air on faces"; }
  void add(const Kinematics& at, Points& forces) const override;
  void couple(std::vector<ParticlePair>& pairs) const override;

  /// The derivatives by velocity. Those by position, of areas, normals and gusts, are left out: they are not symmetric.
  void add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const override;

  /// Dampers up to the expected speed, with areas and lengths as at rest.
  void append_elements(std::vector<LinearElement>& elements) const override;

  /// With areas and lengths as at rest.
  [[nodiscard]] double largest_acceleration() const override;

 private:
  /// The drag of a body, by size.
  struct Law {
    SurfaceDrag faces{};
    double low_speed = 0.0;  ///< kLowSpeed for Body::drag, 0 for the drag of the settings [m/s]
    double diameter = 0.0;   ///< of lines [m]; 0: the body has faces
    double fall = 0.0;       ///< expected speed in addition to that of the wind [m/s]
    double expected = 0.0;   ///< dF/du at the expected speed, by size [kg/(m^2 s)] or [kg/(m s)]
    double share = 0.0;      ///< largest `rest_size * rate_share` of its elements [m^2/kg] or [m/kg]
    Index end = 0;           ///< of its elements, which follow those of the law before
  };
  struct Air;
  struct Flow;
  void add_body(const Body& body, const SurfaceDrag& drag, double gravity, Scalars& sizes);
  void add_element(const AirElement& element, Scalars& sizes);
  void find_shares(const Scalars& sizes);
  void expect_wind();
  void list_elements_of_particles();
  [[nodiscard]] Air air_at(const Kinematics& at) const;
  void find_end_forces(const Kinematics& at, const Air& air, Index begin, Index end, Points& end_forces) const;
  [[nodiscard]] Flow flow(const AirElement& element, const Kinematics& at, const Air& air) const;

  const SpringNetwork& network_;
  Wind wind_;
  double step_;
  std::vector<Law> laws_;
  std::vector<AirElement> elements_;
  std::vector<Index> first_entry_;  ///< by particle, in elements_at_
  std::vector<Index> elements_at_;  ///< the elements of each particle, ascending
};

}  // namespace sprung
