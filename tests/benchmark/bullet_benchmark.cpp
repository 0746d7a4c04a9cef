// The drape of a cloth on the bunny, Bullet's soft body against Sprung, frame by frame in the same run.
#include "benchmark/bullet_drape.h"
#include "benchmark/field_drape.h"
#include "benchmark/processor_time.h"

#include "base/parallel.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <vector>

namespace sprung::benchmarks {
namespace {

// One second: the cloth meets the bunny in frame 2 and hangs folded around it at the end.
constexpr int kFrames = 60;

// From here on it slides and settles: the longest springs of a single frame tell little.
constexpr int kFirstMeasured = 30;

/// How many of a hundred springs are no longer, as parts of their rest length.
struct Stretch {
  double of_50 = 0.0;
  double of_99 = 0.0;
  double of_all = 0.0;
};

struct Measured {
  double seconds = 0.0;  ///< of all frames
  int most_inside = 0;   ///< particles inside in the worst frame
  Stretch stretch;       ///< mean of the frames from kFirstMeasured on
};

void add_stretch(const Springs& springs, const Points& positions, Stretch& mean) {
  std::vector<double> stretches;
  for (std::size_t s = 0; s < springs.first.size(); ++s) {
    const double length = (positions.col(springs.first[s]) - positions.col(springs.second[s])).norm();
    stretches.push_back(length / springs.rest_length[s] - 1.0);
  }
  std::sort(stretches.begin(), stretches.end());
  constexpr int kMeasured = kFrames - kFirstMeasured;
  mean.of_50 += stretches[stretches.size() / 2] / kMeasured;
  mean.of_99 += stretches[stretches.size() * 99 / 100] / kMeasured;
  mean.of_all += stretches.back() / kMeasured;
}

template <class Drape>
Measured run_drape(Drape drape, const Springs& springs, const InsideCount& inside) {
  Measured measured;
  for (int frame = 0; frame < kFrames; ++frame) {
    const double begin = processor_time();
    drape.step_frame();
    measured.seconds += processor_time() - begin;
    measured.most_inside = std::max(measured.most_inside, inside(drape.positions()));
    if (frame >= kFirstMeasured) add_stretch(springs, drape.positions(), measured.stretch);
  }
  return measured;
}

void show(const std::string& name, const Measured& measured, benchmark::State& state) {
  state.counters[name + "_inside"] = measured.most_inside;
  state.counters[name + "_stretch_of_50"] = measured.stretch.of_50;
  state.counters[name + "_stretch_of_99"] = measured.stretch.of_99;
  state.counters[name + "_stretch_of_all"] = measured.stretch.of_all;
}

/// Arguments: triangles, particles along a side. One thread. The time is Sprung's, a frame.
void drape_against_bullet(benchmark::State& state) {
  const auto triangles = static_cast<Index>(state.range(0));
  const auto side = static_cast<Index>(state.range(1));
  const ThreadLimit one_thread(1);
  const InsideCount inside(triangles);
  const SpringNetwork network = drape_network(triangles, side);
  for ([[maybe_unused]] auto _ : state) {
    const Measured bullet = run_drape(BulletDrape(triangles, side), network.springs, inside);
    const Measured sprung = run_drape(SprungDrape(triangles, side), network.springs, inside);
    state.SetIterationTime(sprung.seconds / kFrames);
    state.counters["bullet_ms"] = 1e3 * bullet.seconds / kFrames;
    state.counters["times_faster"] = bullet.seconds / sprung.seconds;
    show("bullet", bullet, state);
    show("sprung", sprung, state);
  }
}

BENCHMARK(drape_against_bullet)
    ->ArgNames({"triangles", "side"})
    ->ArgsProduct({{3700, 14700, 59000}, {64}})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sprung::benchmarks
