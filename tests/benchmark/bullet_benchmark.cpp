// The drape of a cloth on the bunny, Bullet's soft body against Sprung, frame by frame in the same run.
#include "benchmark/bullet_drape.h"
#include "benchmark/field_drape.h"
#include "benchmark/processor_time.h"

#include "base/parallel.h"

#include <benchmark/benchmark.h>

#include <algorithm>

namespace sprung::benchmarks {
namespace {

// One second: the cloth meets the bunny in frame 2 and hangs folded around it at the end.
constexpr int kFrames = 60;

struct Measured {
  double seconds = 0.0;  ///< of all frames
  int most_inside = 0;   ///< particles inside in the worst frame
  double stretch = 0.0;  ///< of the longest spring at the end, as a part of its length
};

double largest_stretch(const Springs& springs, const Points& positions) {
  double largest = 0.0;
  for (std::size_t s = 0; s < springs.first.size(); ++s) {
    const double length = (positions.col(springs.first[s]) - positions.col(springs.second[s])).norm();
    largest = std::max(largest, length / springs.rest_length[s] - 1.0);
  }
  return largest;
}

template <class Drape>
Measured run_drape(Drape drape, const Springs& springs, const InsideCount& inside) {
  Measured measured;
  for (int frame = 0; frame < kFrames; ++frame) {
    const double begin = processor_time();
    drape.step_frame();
    measured.seconds += processor_time() - begin;
    measured.most_inside = std::max(measured.most_inside, inside(drape.positions()));
  }
  measured.stretch = largest_stretch(springs, drape.positions());
  return measured;
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
    state.counters["bullet_inside"] = bullet.most_inside;
    state.counters["sprung_inside"] = sprung.most_inside;
    state.counters["bullet_stretch"] = bullet.stretch;
    state.counters["sprung_stretch"] = sprung.stretch;
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
