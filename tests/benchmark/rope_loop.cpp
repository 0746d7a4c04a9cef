// rope_loop SCENE: times 1000 steps of a scene, the best of several attempts, and prints seconds.
#include "scene/load_scene.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>

int main(int /*argc*/, char** argv) {
  constexpr int kAttempts = 15;
  constexpr int kSteps = 1000;
  sprung::Simulator simulator = sprung::load_scene({.file = argv[1]}).simulator;
  double best = std::numeric_limits<double>::infinity();
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < kSteps; ++k) simulator.step();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  std::printf("%.9f\n", best);
}
