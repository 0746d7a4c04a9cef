#include "simulation/model/network_forces.h"

#include "dynamics/forces/bending_angle_force.h"
#include "dynamics/forces/gravity_and_drag.h"
#include "dynamics/forces/material_dampers.h"
#include "dynamics/forces/pressure_force.h"
#include "dynamics/forces/spring_force.h"

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

}  // namespace sprung
