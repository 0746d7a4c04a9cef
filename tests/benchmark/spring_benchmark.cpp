// Forces and projection of cloths, compared with a textbook network of objects and pointers.
#include "base/parallel.h"
#include "benchmark/textbook_springs.h"
#include "dynamics/forces/spring_force.h"
#include "dynamics/integrators/stable_step.h"
#include "dynamics/network_bounds.h"
#include "dynamics/stretch_limit/stretch_limit.h"
#include "network/network_builder.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace sprung {
namespace {

SpringNetwork cloth(Index side) {
  SpringMaterials materials;
  materials.structural = SpringMaterial{.value = 400.0, .damping = 0.01};
  materials.shear = SpringMaterial{.value = 200.0, .damping = 0.005};
  materials.bend = SpringMaterial{.value = 5.0, .damping = 0.0001};
  BodyShape shape = make_cloth({.size = {1.0, 1.0}, .resolution = {side, side}}, materials);
  set_total_mass(shape, 0.2);
  NetworkBuilder builder;
  const Index first = builder.add_body("cloth", shape);
  builder.pin({first, first + side - 1});
  return builder.build();
}

/// Adds waves, so that no spring has its rest length and most are stretched.
void disturb(SpringNetwork& network) {
  for (Index i = 0; i < network.particle_count(); ++i) {
    network.positions.col(i) *= 1.05;
    network.positions(2, i) = 0.01 * std::sin(50.0 * network.positions(0, i) + 70.0 * network.positions(1, i));
    network.velocities.col(i) = Vector3(std::sin(0.1 * i), std::cos(0.2 * i), std::sin(0.3 * i));
  }
}

void count_springs(benchmark::State& state, Index springs) {
  state.SetItemsProcessed(state.iterations() * springs);
  state.counters["per_spring"] =
      benchmark::Counter(static_cast<double>(springs), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void textbook_forces(benchmark::State& state) {
  SpringNetwork network = cloth(static_cast<Index>(state.range(0)));
  disturb(network);
  textbook::Network objects(network);
  for ([[maybe_unused]] auto _ : state) {
    objects.add_spring_forces();
    benchmark::ClobberMemory();
  }
  count_springs(state, network.springs.count());
}

void forces(benchmark::State& state) {
  const ThreadLimit threads(static_cast<int>(state.range(1)));
  SpringNetwork network = cloth(static_cast<Index>(state.range(0)));
  disturb(network);
  const SpringForce force(network);
  Points total(3, network.particle_count());
  for ([[maybe_unused]] auto _ : state) {
    total.setZero();
    force.add({.x = network.positions, .v = network.velocities}, total);
    benchmark::ClobberMemory();
  }
  count_springs(state, network.springs.count());
}

/// The limits of the measured passes: a stretch of at most 2 %, or neither stretch nor compression.
StretchLimitSettings limit_of(bool both_sides) {
  return both_sides ? StretchLimitSettings{.max_stretch = 0.0, .max_compression = 0.0} : StretchLimitSettings{.max_stretch = 0.02};
}

/// The passes of one step, in a row as in a simulation: positions that a thread has moved are then still in its cache.
constexpr int kPasses = 20;

// Both benchmarks start from the same stretched cloth. The measured time includes copying it.
void textbook_projection(benchmark::State& state) {
  SpringNetwork network = cloth(static_cast<Index>(state.range(0)));
  disturb(network);
  textbook::Network objects(network);
  const StretchLimitSettings settings = limit_of(state.range(1) != 0);
  for ([[maybe_unused]] auto _ : state) {
    for (Index i = 0; i < network.particle_count(); ++i) objects.masses[i]->position = network.positions.col(i);
    for (int pass = 0; pass < kPasses; ++pass) objects.project(settings.max_stretch, settings.max_compression);
    benchmark::ClobberMemory();
  }
  count_springs(state, kPasses * static_cast<Index>(objects.structural.size()));
}

void projection(benchmark::State& state) {
  const ThreadLimit threads(static_cast<int>(state.range(1)));
  SpringNetwork network = cloth(static_cast<Index>(state.range(0)));
  disturb(network);
  const StretchLimit limit(network, limit_of(state.range(2) != 0));
  const Index side = static_cast<Index>(state.range(0));
  Points positions = network.positions;
  for ([[maybe_unused]] auto _ : state) {
    positions = network.positions;
    for (int pass = 0; pass < kPasses; ++pass) benchmark::DoNotOptimize(limit.project(network.positions, positions));
  }
  count_springs(state, kPasses * 2 * side * (side - 1));
}

void bounds(benchmark::State& state) {
  const SpringNetwork network = cloth(static_cast<Index>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(spectral_bounds(network));
  count_springs(state, network.springs.count());
}

BENCHMARK(textbook_forces)->ArgName("side")->Arg(64)->Arg(256)->Arg(512)->UseRealTime();
BENCHMARK(forces)->ArgNames({"side", "threads"})->ArgsProduct({{64, 256, 512}, {1, 2}})->UseRealTime();
BENCHMARK(textbook_projection)->ArgNames({"side", "both_sides"})->ArgsProduct({{64, 256, 512}, {0, 1}})->UseRealTime();
BENCHMARK(projection)->ArgNames({"side", "threads", "both_sides"})->ArgsProduct({{64, 256, 512}, {1, 2}, {0, 1}})->UseRealTime();
BENCHMARK(bounds)->ArgName("side")->Arg(64)->Arg(512)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sprung
