#include "app/energy_gain.h"

#include "base/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

// Symplectic schemes let the energy of undamped springs swing by a third in their largest steps, and keep it in the mean.
constexpr double kMostGained = 0.5;

// Of the coordinates, a step: what moves less moves by rounding.
constexpr double kRounding = 0x1p-26;

bool is_left_alone(const Simulator& simulator) {
  const SimulatorSettings& settings = simulator.settings();
  const auto& obstacles = simulator.environment().obstacles();
  const bool pushed = settings.contact.response == ContactSettings::Response::penalty && !obstacles.empty();
  const bool blown = settings.air_drag > 0.0 && !settings.wind.isZero(0.0);
  return !pushed && !blown && !std::holds_alternative<ExplicitEulerSettings>(settings.integrator) &&
         std::ranges::none_of(simulator.network().pins, [](const Pin& pin) { return pin.motion.moves(); }) &&
         std::ranges::none_of(obstacles, [](const Obstacle& obstacle) { return obstacle.changes(); });
}

}  // namespace

EnergyGain::EnergyGain(const Simulator& simulator) : simulator_(simulator), sees_(is_left_alone(simulator)) {}

void EnergyGain::see(const FrameDiagnostics& frame) {
  if (!sees_ || frame.frame == 1) return;
  const At now{frame.frame, frame.kinetic_energy + frame.elastic_energy + frame.gravity_energy};
  most_kinetic_ = std::max(most_kinetic_, frame.kinetic_energy);
  if (!least_ || now.energy < least_->energy) least_ = now;
  if (now.energy - least_->energy <= to_.energy - from_.energy) return;
  from_ = *least_;
  to_ = now;
}

/// What falls by a height h is up to half a step's way, g t dt / 2, apart from where its speed says it is; what hangs by a limit
/// bounces by less than the length of a spring; what rests moves by rounding.
double EnergyGain::seeming() const {
  const SpringNetwork& network = simulator_.network();
  const SimulatorSettings& settings = simulator_.settings();
  const double mass = network.masses.sum();
  const double speed = std::sqrt(2.0 * most_kinetic_ / mass);
  double way = speed * settings.step;
  const std::vector<double>& lengths = network.springs.rest_length;
  if (settings.stretch_limit && !lengths.empty()) way += *std::ranges::max_element(lengths);
  const double rounding = kRounding * simulator_.positions().cwiseAbs().maxCoeff() / settings.step;
  return mass * (settings.gravity.norm() * way + 0.5 * rounding * rounding);
}

std::optional<std::string> EnergyGain::warning() const {
  const double gained = to_.energy - from_.energy;
  if (!(gained > kMostGained * most_kinetic_) || gained <= seeming()) return std::nullopt;
  return fmt::format(
      "motion, springs and height held {} J in frame {} and {} J in frame {}, though nothing drives them: smaller steps, or more "
      "damping, would keep their energy",
      format_number(from_.energy, 3), from_.frame, format_number(to_.energy, 3), to_.frame);
}

}  // namespace sprung
