// A jelly falls on a floor and keeps its volume: Bullet's soft body and Sprung in the same run, and how the time grows with the
// resolution.
#include "benchmark/bullet_jelly.h"
#include "benchmark/processor_time.h"

#include "base/parallel.h"
#include "network/network_builder.h"
#include "network/total_volume.h"
#include "simulation/simulator.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

namespace sprung::benchmarks {
namespace {

constexpr int kFrames = 60;
constexpr double kFrameTime = 1.0 / 60.0;  // [s]
constexpr double kGravity = 9.81;          // [m/s^2]
constexpr int kSteps = 2;                  // a frame
constexpr int kPasses = 20;                // a frame, in all steps
static_assert(kPasses % kSteps == 0);
constexpr double kSide = 0.2;  // [m]

/// A cube 5 cm above the floor. Its springs are without force: passes alone carry it, as they carry Bullet's soft body.
SpringNetwork jelly_network(Index side) {
  const SpringMaterial without_force{};
  BodyShape shape =
      make_solid({.size = {kSide, kSide, kSide}, .resolution = {side, side, side}}, {without_force, without_force, {}});
  set_density(shape, 1000.0);
  shape.preserve_volume = true;
  place(shape, RigidTransform(Eigen::Translation3d(0.0, 0.05 + 0.5 * kSide, 0.0)));
  NetworkBuilder builder;
  builder.add_body("jelly", shape, {.thickness = 0.002, .friction = 0.3, .static_friction = 0.3});
  return builder.build();
}

/// Like Bullet's links, springs may neither stretch nor shrink. A jelly at rest must not sleep, as it would cost nothing.
SimulatorSettings jelly_settings() {
  using enum SpringKind;
  return {.step = kFrameTime / kSteps,
          .gravity = {0.0, -kGravity, 0.0},
          .stretch_limit = StretchLimitSettings{.max_stretch = 0.0,
                                                .max_compression = 0.0,
                                                .kinds = {structural, shear},
                                                .iterations = kPasses / kSteps,
                                                .solver = StretchLimitSettings::Solver::gauss_seidel},
          .sleep = false};
}

struct Measured {
  double seconds = 0.0;       ///< a frame
  double volume_error = 0.0;  ///< the largest after any frame, as a fraction
  double passes = 0.0;        ///< a frame; of Sprung alone
};

template <class StepFrame, class Positions>
Measured run(const SpringNetwork& network, const StepFrame& step_frame, const Positions& positions) {
  Measured measured;
  for (int frame = 0; frame < kFrames; ++frame) {
    const double begin = processor_time();
    step_frame();
    measured.seconds += (processor_time() - begin) / kFrames;
    const double volume = testing::total_volume(network.bodies.front().cells, positions());
    measured.volume_error = std::max(measured.volume_error, std::abs(volume / (kSide * kSide * kSide) - 1.0));
  }
  return measured;
}

Measured run_sprung(const SpringNetwork& network) {
  Simulator simulator(network, jelly_settings(), {Obstacle{.name = "floor", .geometry = HalfSpaceGeometry{}}});
  double passes = 0.0;
  const auto step_frame = [&] {
    for (int step = 0; step < kSteps; ++step) passes += static_cast<double>(simulator.step().iterations) / kFrames;
  };
  Measured measured = run(network, step_frame, [&]() -> const Points& { return simulator.positions(); });
  measured.passes = passes;
  return measured;
}

Measured run_bullet(const SpringNetwork& network) {
  BulletJelly bullet(network, kGravity, kFrameTime / kSteps, kPasses / kSteps);
  const auto step_frame = [&] {
    for (int step = 0; step < kSteps; ++step) bullet.step();
  };
  return run(network, step_frame, [&] { return bullet.positions(); });
}

/// Argument: particles along a side. One thread. The reported time is Sprung's time a frame.
void jelly_against_bullet(benchmark::State& state) {
  const ThreadLimit one_thread(1);
  const SpringNetwork network = jelly_network(static_cast<Index>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) {
    const Measured of_bullet = run_bullet(network);
    const Measured of_sprung = run_sprung(network);
    state.SetIterationTime(of_sprung.seconds);
    state.counters["bullet_ms"] = 1e3 * of_bullet.seconds;
    state.counters["times_faster"] = of_bullet.seconds / of_sprung.seconds;
    state.counters["passes"] = of_sprung.passes;
    state.counters["bullet_volume_error_%"] = 100.0 * of_bullet.volume_error;
    state.counters["volume_error_%"] = 100.0 * of_sprung.volume_error;
  }
}

/// A jelly of 40^3 particles beside one of 20^3. One thread. The reported time is that of the larger one.
void jelly_growth(benchmark::State& state) {
  const ThreadLimit one_thread(1);
  for ([[maybe_unused]] auto _ : state) {
    const Measured small = run_sprung(jelly_network(20));
    const Measured large = run_sprung(jelly_network(40));
    state.SetIterationTime(large.seconds);
    state.counters["times_20^3"] = large.seconds / small.seconds;
    state.counters["passes"] = large.passes;
    state.counters["volume_error_%"] = 100.0 * large.volume_error;
  }
}

BENCHMARK(jelly_against_bullet)->ArgName("side")->Arg(20)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(jelly_growth)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sprung::benchmarks
