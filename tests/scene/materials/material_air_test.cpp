// Presets in the air, which they have unless the scene says otherwise.
#include "scene/building/scene_builder.h"
#include "scene/scene_text.h"
#include "simulation/diagnostics.h"
#include "simulation/simulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace sprung {
namespace {

/// The energies [J] of a rope of hemp of 1 m that is let go at 45 degrees, from that at which it hangs, by seconds.
std::vector<double> energies_of_swing(int particles, int seconds, const std::vector<std::string>& changes = {}) {
  const SceneFolder folder;
  const std::string text = R"({"duration": 60, "frame_rate": 30, "bodies": {"rope": {"material": "hemp", "shape": {"type": "rope",
      "from": [0, 0, 0], "to": [0.7071067811865476, -0.7071067811865476, 0], "particles": )" +
                           std::to_string(particles) + R"(}, "pins": [{"at": "corner", "which": ["from"]}]}}})";
  const BuiltScene scene = build_scene(folder.read(text, changes));
  Simulator simulator(scene.network, scene.settings);
  FrameRunner frames(simulator);
  const double hanging = -0.5 * scene.network.masses.sum() * 9.81;  // uniform along 1 m
  std::vector<double> energies;
  FrameDiagnostics frame = frames.first_frame();
  for (int k = 0; k <= 30 * seconds; ++k) {
    if (k > 0) frame = frames.next_frame();
    if (k % 30 == 0) energies.push_back(frame.kinetic_energy + frame.elastic_energy + frame.gravity_energy - hanging);
  }
  return energies;
}

// A rigid rod of mass m and length L that swings with the largest angular velocity w loses to quadratic drag, by cycle averages,
// dE/dt = -1/2 rho d C w^3 L^4 / 4 * 4 / (3 pi), with E = m L^2 w^2 / 6: w falls as w0 / (1 + 0.0245 1/rad C w0 t), with C
// from 1.06 to 1.3 and w0 = 2.9 rad/s, so that a tenth of the energy is left after 25 s. A rope bends, which takes more.
TEST(MaterialAir, AHempRopeThatSwingsLosesNineTenthsOfItsEnergyInAMinute) {
  for (const int particles : {11, 21}) {
    const std::vector<double> energies = energies_of_swing(particles, 60);
    std::printf("hemp, %d particles: %.1f %% of the energy after 10 s, %.1f %% after 30 s, %.2f %% after 60 s\n", particles,
                100.0 * energies[10] / energies[0], 100.0 * energies[30] / energies[0], 100.0 * energies[60] / energies[0]);
    EXPECT_LT(energies[60], 0.1 * energies[0]) << particles;
    for (std::size_t second = 1; second < energies.size(); ++second) {
      EXPECT_LE(energies[second], energies[second - 1] + 1e-3 * energies[0]) << second;
    }
  }
}

// By the decay above, with the smallest C, the air leaves 1 / (1 + 0.0245 * 1.06 * 2.9 * 10)^2 = 0.33 of the energy after 10 s. The
// bending of a rope takes energy in vacuum too, and slows it, so that the air takes less than from a rod: up to half is left.
TEST(MaterialAir, VacuumTakesLess) {
  const std::vector<double> in_air = energies_of_swing(11, 10);
  const std::vector<double> in_vacuum = energies_of_swing(11, 10, {"air=false"});
  std::printf("hemp after 10 s: %.1f %% of the energy in air, %.1f %% in vacuum\n", 100.0 * in_air[10] / in_air[0],
              100.0 * in_vacuum[10] / in_vacuum[0]);
  EXPECT_LT(in_air[10], 0.5 * in_vacuum[10]);
}

}  // namespace
}  // namespace sprung
