#include "simulation/monitoring/energy_watch.h"

#include "base/format.h"

#include <algorithm>
#include <numbers>

namespace sprung {
namespace {

constexpr double kExploded = 1000.0;

// See note_obstacle().
constexpr double kWedge = 32.0;

// Of what springs hold, motion is at most this part where they are stretched slowly.
constexpr double kSlow = 0.01;

// Of the coordinates, a step: what moves less moves by rounding.
constexpr double kRounding = 0x1p-26;

double capacity_of(const SpringNetwork& network) {
  const Springs& springs = network.springs;
  double energy = 0.0;
  for (Index s = 0; s < springs.count(); ++s)
    energy += 0.5 * springs.stiffness[s] * springs.rest_length[s] * springs.rest_length[s];
  for (const double k : network.angle_bends.stiffness) energy += 0.5 * k * std::numbers::pi * std::numbers::pi;
  return energy;
}

/// A limit holds energy as stiff springs do: what hangs by it a little too long bounces. That is less than the weight of all times
/// the length of a spring.
double capacity_of_limit(const SpringNetwork& network, const SimulatorSettings& settings) {
  const std::vector<double>& lengths = network.springs.rest_length;
  if (!settings.stretch_limit || lengths.empty()) return 0.0;
  return network.masses.sum() * settings.gravity.norm() * *std::ranges::max_element(lengths);
}

double bounce_gain(const SpringNetwork& network, const std::vector<Obstacle>& obstacles) {
  double restitution = 0.0;
  for (const Body& body : network.bodies) restitution = std::max(restitution, body.material.restitution);
  for (const Obstacle& obstacle : obstacles) restitution = std::max(restitution, obstacle.material.restitution);
  return kWedge * (1.0 + restitution) / (1.0 - restitution);
}

double energy_of_rounding(const SpringNetwork& network, double step) {
  if (network.particle_count() == 0) return 0.0;
  const double speed = kRounding * network.positions.cwiseAbs().maxCoeff() / step;
  return 0.5 * network.masses.sum() * speed * speed;
}

}  // namespace

EnergyWatch::EnergyWatch(const SpringNetwork& network, const SimulatorSettings& settings, const std::vector<Obstacle>& obstacles)
    : mass_(network.masses.sum()),
      watches_(obstacles.empty() || settings.contact.response == ContactSettings::Response::projection),
      bounce_gain_(bounce_gain(network, obstacles)),
      fastest_drive_(settings.air_drag > 0.0 ? settings.wind.norm() : 0.0),
      capacity_(capacity_of(network) + capacity_of_limit(network, settings) + energy_of_rounding(network, settings.step)) {}

void EnergyWatch::note(std::int64_t step, const Energies& energies) {
  if (step <= 1) start_ = std::max(start_, energies.kinetic + energies.elastic);
  highest_ = step == 0 ? energies.gravity : std::max(highest_, energies.gravity);
  most_kinetic_ = std::max(most_kinetic_, energies.kinetic);
  if (most_kinetic_ < kSlow * energies.elastic) stored_ = std::max(stored_, energies.elastic);
}

std::optional<std::string> EnergyWatch::explosion(const Energies& energies) const {
  const double held = energies.kinetic + energies.elastic;
  if (!watches_ || held <= kExploded * put_in(energies)) return std::nullopt;
  return "its energy exploded: motion and springs hold " + format_number(held, 3) + " J, of which no more than " +
         format_number(put_in(energies), 3) + " J can have been put in";
}

double EnergyWatch::put_in(const Energies& energies) const {
  const double driven = 0.5 * mass_ * fastest_drive_ * fastest_drive_;
  return start_ + std::max(0.0, highest_ - energies.gravity) + driven + stored_ + capacity_;
}

}  // namespace sprung
