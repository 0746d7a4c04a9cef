// Scenes with nothing but their bodies, obstacles and limits: what default settings cost, and how well they hold the stretch limit.
#include "benchmark/processor_time.h"

#include "base/parallel.h"
#include "scene/building/scene_builder.h"
#include "scene/reading/scene_reader.h"
#include "simulation/simulator.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace sprung::benchmarks {
namespace {

struct Frames {
  int first;
  int last;
};

// Cloths lie on the bunny, and swinging bodies are fast.
constexpr Frames kMeasured{20, 60};

// What lies at rest sleeps.
constexpr Frames kMeasuredAtRest{80, 120};

/// Stretch of the structural springs in ascending order, as fractions of their rest length.
std::vector<double> stretches(const SpringNetwork& network, const Points& x) {
  const Springs& springs = network.springs;
  std::vector<double> all;
  for (Index s = 0; s < springs.count(); ++s) {
    if (springs.kind[s] != SpringKind::structural) continue;
    all.push_back((x.col(springs.first[s]) - x.col(springs.second[s])).norm() / springs.rest_length[s] - 1.0);
  }
  std::ranges::sort(all);
  return all;
}

/// Runs tests/benchmark/scenes/<name>.json with changed values, with one thread. The reported time is the mean of
/// the measured frames.
void run(benchmark::State& state, const std::string& name, const std::vector<std::string>& changes, const Frames& measured) {
  const ThreadLimit one_thread(1);
  const Scene scene = read_scene(SPRUNG_SOURCE_DIR "/tests/benchmark/scenes/" + name + ".json", changes);
  for ([[maybe_unused]] auto _ : state) {
    BuiltScene built = build_scene(scene, {SPRUNG_TEST_MESHES});
    Simulator simulator(std::move(built.network), built.settings, std::move(built.obstacles));
    double seconds = 0.0;
    double first = 0.0;
    double percentile_99 = 0.0;
    double worst = 0.0;
    for (int frame = 1; frame <= measured.last; ++frame) {
      const double begin = processor_time();
      for (int step = 0; step < built.settings.steps_per_frame; ++step) simulator.step();
      const double taken = processor_time() - begin;
      if (frame == 1) first = taken;
      if (frame < measured.first) continue;
      seconds += taken / (measured.last - measured.first + 1);
      const std::vector<double> sorted = stretches(simulator.network(), simulator.positions());
      percentile_99 = std::max(percentile_99, sorted[sorted.size() * 99 / 100]);
      worst = std::max(worst, sorted.back());
    }
    state.SetIterationTime(seconds);
    state.counters["first_ms"] = 1e3 * first;
    state.counters["99_in_100_%"] = 100.0 * percentile_99;
    state.counters["worst_%"] = 100.0 * worst;
    state.counters["steps"] = built.settings.steps_per_frame * built.settings.max_substeps;
  }
}

std::string resolution(const std::string& body, int side) {
  const std::string n = std::to_string(side);
  return "bodies." + body + ".shape.resolution=[" + n + "," + n + "]";
}

void add(const std::string& title, const std::string& scene, const std::vector<std::string>& changes = {},
         const Frames& measured = kMeasured) {
  benchmark::RegisterBenchmark(title.c_str(), [=](benchmark::State& state) { run(state, scene, changes, measured); })
      ->Iterations(1)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

[[maybe_unused]] const bool kAdded = [] {
  for (const int side : {64, 128, 256}) add("drape/" + std::to_string(side), "drape", {resolution("cloth", side)});
  for (const int side : {64, 128}) {
    add("drape_with_self_contact/" + std::to_string(side), "drape", {resolution("cloth", side), "bodies.cloth.self_contact=true"});
  }
  for (const int side : {64, 128, 256}) {
    add("hanging_cloth/" + std::to_string(side), "cloth", {resolution("cloth", side)});
    add("swinging_cloth/" + std::to_string(side), "cloth",
        {resolution("cloth", side), "bodies.cloth.place={\"rotation\":[-90,0,0]}"});
  }
  for (const int particles : {1000, 10000}) {
    add("swinging_rope/" + std::to_string(particles), "rope", {"bodies.rope.shape.particles=" + std::to_string(particles)});
  }
  add("flag_with_self_contact", "flag");
  add("jelly", "jelly");
  add("carpet_with_a_lifted_corner", "carpet", {}, kMeasuredAtRest);
  add("carpet_with_a_lifted_corner_awake", "carpet", {"sleep=false"}, kMeasuredAtRest);
  return true;
}();

}  // namespace
}  // namespace sprung::benchmarks
