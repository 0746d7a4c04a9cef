// The time of a frame while a cloth drapes over the bunny, the main use of Sprung.
#include "base/parallel.h"
#include "benchmark/field_drape.h"
#include "scene/building/scene_builder.h"
#include "scene/reading/scene_reader.h"
#include "simulation/diagnostics.h"

#include <benchmark/benchmark.h>

namespace sprung::benchmarks {
namespace {

/// The first second of the drape of field_drape.h. Arguments: triangles, particles along a side, threads.
void field_drape(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(2)));
  SprungDrape drape(static_cast<Index>(state.range(0)), static_cast<Index>(state.range(1)));
  for ([[maybe_unused]] auto _ : state) drape.step_frame();
}

BENCHMARK(field_drape)
    ->ArgNames({"triangles", "side", "threads"})
    ->ArgsProduct({{3700, 14700, 59000}, {64, 128}, {1, 2}})
    ->Iterations(60)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// The cloth touches the ears in frame 5 and is folded over the back by frame 20.
constexpr int kFirstFrame = 15;
constexpr int kFrames = 15;

/// examples/cloth_on_bunny.json without self-contact, as it was measured from the start. Argument: threads.
void cloth_on_bunny(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(0)));
  Scene scene = read_scene(SPRUNG_SOURCE_DIR "/examples/cloth_on_bunny.json");
  scene.bodies.at(0).contact.self = false;
  BuiltScene built = build_scene(scene, {SPRUNG_TEST_MESHES});
  Simulator simulator(std::move(built.network), built.settings, std::move(built.obstacles));
  FrameRunner frames(simulator);
  for (int frame = 0; frame < kFirstFrame; ++frame) frames.next_frame();
  double contacts = 0.0;
  for (auto _ : state) contacts += frames.next_frame().contacts;
  state.counters["steps_per_frame"] = built.settings.steps_per_frame;
  state.counters["contacts"] = contacts / static_cast<double>(state.iterations());
}

BENCHMARK(cloth_on_bunny)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Iterations(kFrames)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace sprung::benchmarks
