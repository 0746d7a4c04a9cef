#include "simulation/monitoring/energy_watch.h"

#include "base/format.h"
#include "dynamics/attachments/attachments.h"
#include "network/model/activity.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

constexpr double kExploded = 1000.0;

// See note_obstacle().
constexpr double kWedge = 32.0;

// While springs are stretched slowly, the kinetic energy is below this fraction of the elastic energy.
constexpr double kSlow = 0.01;

// Symplectic schemes let the energy of undamped springs oscillate by a third at their largest stable step, and keep its mean.
constexpr double kMaxGain = 0.5;

// Displacement in a step, as a fraction of the coordinates, that rounding may cause.
constexpr double kRounding = 0x1p-26;

/// A limit stores energy as stiff springs do: a body that hangs by a slightly overstretched limit bounces by less than the length
/// of a spring [m].
double bounce_height_of(const SpringNetwork& network, const SimulatorSettings& settings) {
  const std::vector<double>& lengths = network.springs.rest_length;
  return settings.stretch_limit && !lengths.empty() ? *std::ranges::max_element(lengths) : 0.0;
}

double bounce_gain(const SpringNetwork& network, const std::vector<Obstacle>& obstacles) {
  double restitution = 0.0;
  for (const Body& body : network.bodies) restitution = std::max(restitution, body.material.restitution);
  for (const Obstacle& obstacle : obstacles) restitution = std::max(restitution, obstacle.material.restitution);
  return kWedge * (1.0 + restitution) / (1.0 - restitution);
}

double rounding_speed(const Points& positions, double step) {
  return positions.cols() == 0 ? 0.0 : kRounding * positions.cwiseAbs().maxCoeff() / step;
}

bool feels_air(const SpringNetwork& network, const SimulatorSettings& settings) {
  return settings.has_air() || has_own_drag(network);
}

bool is_undriven(const SpringNetwork& network, const SimulatorSettings& settings, const std::vector<Obstacle>& obstacles) {
  const bool wind = feels_air(network, settings) && !settings.wind.is_calm();
  return !wind && !do_work(network.attachments) && !std::holds_alternative<ExplicitEulerSettings>(settings.integrator) &&
         !has_moving_pin(network.pins) &&
         std::ranges::none_of(obstacles, [](const Obstacle& obstacle) { return obstacle.changes(); });
}

}  // namespace

EnergyWatch::EnergyWatch(const SpringNetwork& network, const SimulatorSettings& settings, const std::vector<Obstacle>& obstacles,
                         const Forces& forces)
    : mass_(network.masses.sum()),
      wind_(feels_air(network, settings) ? settings.wind.max_speed() : 0.0),
      bounce_gain_(bounce_gain(network, obstacles)) {
  const double rounding = rounding_speed(network.positions, settings.step);
  capacity_ = mass_ * settings.gravity.norm() * bounce_height_of(network, settings) + 0.5 * mass_ * rounding * rounding;
  for (const auto& force : forces) capacity_ += force->capacity();
}

void EnergyWatch::note_change(const Energies& energies, EnergyMemory& memory) {
  note(0, energies, memory);
  memory.highest_gravity = energies.gravity;
}

void EnergyWatch::note(std::int64_t step, const Energies& energies, EnergyMemory& memory) {
  if (step <= 1) memory.start = std::max(memory.start, energies.kinetic + energies.of_springs());
  memory.highest_gravity = std::max(memory.highest_gravity, energies.gravity);
  memory.max_kinetic = std::max(memory.max_kinetic, energies.kinetic);
  if (memory.max_kinetic < kSlow * energies.of_springs()) memory.stored = std::max(memory.stored, energies.of_springs());
}

std::optional<std::string> EnergyWatch::explosion(const Energies& energies, const EnergyMemory& memory) const {
  const double present = energies.kinetic + energies.of_springs();
  if (present <= kExploded * supplied(energies, memory)) return std::nullopt;
  return "the energy exploded: the energies of motion and springs are " + format_number(present, 3) + " J, but at most " +
         format_number(supplied(energies, memory), 3) + " J can have been supplied";
}

double EnergyWatch::supplied(const Energies& energies, const EnergyMemory& memory) const {
  const double drive = std::max(wind_, memory.fastest_drive);
  const double released = std::max(0.0, memory.highest_gravity - energies.gravity);
  return memory.start + released + 0.5 * mass_ * drive * drive + memory.stored + capacity_;
}

EnergyGain::EnergyGain(const SpringNetwork& network, const SimulatorSettings& settings, const std::vector<Obstacle>& obstacles)
    : mass_(network.masses.sum()),
      step_(settings.step),
      gravity_(settings.gravity.norm()),
      bounce_height_(bounce_height_of(network, settings)),
      undriven_(is_undriven(network, settings, obstacles)) {}

void EnergyGain::note_frame(int frame, const Energies& energies, EnergyGainMemory& memory) const {
  if (!undriven_ || frame == 1) return;
  const FrameEnergy now{frame, energies.kinetic + energies.of_springs() + energies.gravity};
  memory.max_kinetic = std::max(memory.max_kinetic, energies.kinetic);
  if (!memory.lowest || now.energy < memory.lowest->energy) memory.lowest = now;
  if (now.energy - memory.lowest->energy <= memory.rise_end.energy - memory.rise_begin.energy) return;
  memory.rise_begin = *memory.lowest;
  memory.rise_end = now;
}

/// A falling particle is up to half a step's displacement, g t dt / 2, from where its speed implies; a body on a stretch limit
/// bounces by less than the length of a spring; a resting particle moves by rounding.
double EnergyGain::apparent_gain(const Points& positions, const EnergyGainMemory& memory) const {
  const double speed = std::sqrt(2.0 * memory.max_kinetic / mass_);
  const double height = speed * step_ + bounce_height_;
  const double rounding = rounding_speed(positions, step_);
  return mass_ * (gravity_ * height + 0.5 * rounding * rounding);
}

std::optional<std::string> EnergyGain::gain(const Points& positions, const EnergyGainMemory& memory) const {
  const double gained = memory.rise_end.energy - memory.rise_begin.energy;
  if (!(gained > kMaxGain * memory.max_kinetic) || gained <= apparent_gain(positions, memory)) return std::nullopt;
  return "the total energy rose from " + format_number(memory.rise_begin.energy, 3) + " J in frame " +
         std::to_string(memory.rise_begin.frame) + " to " + format_number(memory.rise_end.energy, 3) + " J in frame " +
         std::to_string(memory.rise_end.frame) + ", although nothing drives the scene. Use a smaller step or more damping.";
}

}  // namespace sprung
