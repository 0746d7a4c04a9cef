// The drape of a cloth on the bunny: Bullet's soft body and Sprung in the same run.
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

// One second: the cloth touches the bunny in frame 2 and hangs folded around it at the end.
constexpr int kFrames = 60;

// From this frame on the cloth slides and settles. Stretch is averaged over these frames, as the longest springs vary from frame to
// frame.
constexpr int kFirstMeasured = 30;

/// Percentiles of the springs' stretch, as fractions of their rest length.
struct Stretch {
  double median = 0.0;
  double percentile_99 = 0.0;
  double largest = 0.0;
};

struct Measured {
  double seconds = 0.0;  ///< of all frames
  int most_inside = 0;   ///< particles inside the bunny in the worst frame
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
  mean.median += stretches[stretches.size() / 2] / kMeasured;
  mean.percentile_99 += stretches[stretches.size() * 99 / 100] / kMeasured;
  mean.largest += stretches.back() / kMeasured;
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
  state.counters[name + "_median_stretch"] = measured.stretch.median;
  state.counters[name + "_99th_percentile_stretch"] = measured.stretch.percentile_99;
  state.counters[name + "_largest_stretch"] = measured.stretch.largest;
}

/// Arguments: triangles, particles along a side. One thread. The reported time is Sprung's time a frame.
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
