#include "simulation/model/force_factory.h"

#include "dynamics/constraints/carried_surface.h"
#include "dynamics/constraints/cell_volume.h"
#include "dynamics/constraints/enclosed_volume.h"
#include "dynamics/contact/penalty_contact.h"
#include "dynamics/forces/bending_angle_force.h"
#include "dynamics/forces/gravity_and_drag.h"
#include "dynamics/forces/material_dampers.h"
#include "dynamics/forces/pressure_force.h"
#include "dynamics/forces/spring_force.h"
#include "dynamics/forces/surface_air_force.h"

#include <algorithm>

namespace sprung {

Forces network_forces(const SpringNetwork& network, const SimulatorSettings& settings, MaterialDampers dampers) {
  Forces forces;
  forces.push_back(std::make_unique<Gravity>(network, settings.gravity));
  const bool bends = network.angle_bends.count() + network.face_bends.count() > 0;
  if (dampers == MaterialDampers::within) {
    forces.push_back(std::make_unique<SpringForce>(network));
    if (bends) forces.push_back(std::make_unique<BendingAngleForce>(network));
  } else {
    forces.push_back(std::make_unique<SpringForce>(network, springs_without_material_dampers(network)));
    if (bends) forces.push_back(std::make_unique<BendingAngleForce>(network, bends_without_material_dampers(network)));
  }
  if (settings.air_drag > 0.0) forces.push_back(std::make_unique<AirDrag>(network, settings.air_drag, settings.wind));
  if (has_pressure(network)) forces.push_back(std::make_unique<PressureForce>(network));
  return forces;
}

std::unique_ptr<Force> surface_air(const SpringNetwork& network, const SimulatorSettings& settings) {
  if (settings.air_surface.is_zero() && !has_own_drag(network)) return nullptr;
  const bool implicit = std::holds_alternative<ImplicitEulerSettings>(settings.integrator);
  auto air = std::make_unique<SurfaceAirForce>(network, settings.air_surface, settings.wind, settings.gravity.norm(),
                                               implicit ? 0.0 : settings.step);
  if (air->is_empty()) return nullptr;
  return air;
}

std::unique_ptr<ContactForce> penalty_contact(const SpringNetwork& network, const SimulatorSettings& settings,
                                              const ObstacleSet& obstacles) {
  if (settings.contact.response != ContactSettings::Response::penalty || obstacles.empty()) return nullptr;
  return std::make_unique<PenaltyContact>(network, obstacles, settings.contact.stiffness, settings.contact.damping, settings.step);
}

std::vector<LinearElement> penalty_elements(const SpringNetwork& network, const SimulatorSettings& settings) {
  std::vector<LinearElement> anchors;
  append_penalty_elements(network, settings.contact.stiffness, settings.contact.damping, anchors);
  return anchors;
}

Constraints network_constraints(const SpringNetwork& network) {
  Constraints constraints;
  const auto any = [&](const auto& asks) { return std::ranges::any_of(network.bodies, asks); };
  if (any([](const Body& body) { return !body.carried.empty(); })) constraints.push_back(std::make_shared<CarriedSurface>(network));
  if (any([](const Body& body) { return body.preserve_volume; })) constraints.push_back(std::make_shared<CellVolume>(network));
  if (any([](const Body& body) { return body.volume_factor != 0.0; })) {
    constraints.push_back(std::make_shared<EnclosedVolume>(network));
  }
  return constraints;
}

}  // namespace sprung
