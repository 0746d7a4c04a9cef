// The cost of the viewer: cloth_on_bunny, live and as a replay, watched by one page that only receives.
#include "base/parallel.h"
#include "output/run_output.h"
#include "simulation/diagnostics.h"
#include "viewer/live/live_session.h"
#include "viewer/replay/replay_session.h"
#include "viewer/test_client.h"

#include <benchmark/benchmark.h>

#include <chrono>
#include <filesystem>
#include <string>

namespace sprung::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kFrames = 90;
constexpr int kReplayFrames = 30;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

SceneSource bunny_scene(std::vector<std::string> overrides = {}) {
  overrides.emplace_back("bodies.cloth.self_contact=false");  // what was measured from the start
  return {.file = SPRUNG_SOURCE_DIR "/examples/cloth_on_bunny.json", .overrides = overrides, .mesh_paths = {SPRUNG_TEST_MESHES}};
}

/// The reported time is the mean time of the first 90 frames of the simulation alone. `ms_watched` is the time of a frame that a
/// page receives, and `ms_publishing` the time that the simulation's thread needs to make and publish a frame.
void live_view(benchmark::State& state) {
  for ([[maybe_unused]] auto _ : state) {
    LiveRun run(bunny_scene());
    const int steps = run.loaded().simulator.settings().steps_per_frame;
    double simulating = 0.0;
    double publishing = 0.0;
    for (int frame = 0; frame < kFrames; ++frame) {
      const auto begin = Clock::now();
      for (int k = 0; k < steps; ++k) run.step();
      simulating += seconds_since(begin);
      const auto computed = Clock::now();
      benchmark::DoNotOptimize(std::make_shared<const Bytes>(frame_message({}, run.numbers(), run.state())));
      publishing += seconds_since(computed);
    }
    state.SetIterationTime(simulating / kFrames);

    const auto begin = Clock::now();
    LiveSession session(bunny_scene(), {});
    const testing::ServingServer server(session);
    testing::TestPage page(server.port());
    page.frame();
    state.counters["s_to_first_picture"] = seconds_since(begin);
    page.send({{"do", "speed"}, {"factor", 0}});
    page.send({{"do", "play"}});
    const auto played = Clock::now();
    int received = 0;
    for (std::uint32_t number = 0; number < kFrames; ++received) number = page.frame().frame();
    state.counters["ms_watched"] = 1e3 * seconds_since(played) / kFrames;
    state.counters["frames_received"] = received;
    state.counters["ms_publishing"] = 1e3 * publishing / kFrames;
  }
}
BENCHMARK(live_view)->Name("live_cloth_on_bunny_64")->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);

/// Records the start of cloth_on_bunny with 256 x 256 particles, without stiffness and in few large steps: only its size matters.
void record(const std::filesystem::path& folder) {
  LoadedScene loaded =
      load_scene(bunny_scene({"bodies.cloth.shape.resolution=[256,256]", R"(bodies.cloth.springs={"structural":{"stiffness":0}})",
                              R"(stretch_limit={"iterations":4})", "frame_rate=100", "step=0.01"}));
  RunOutput output(OutputFolder(folder.string(), true),
                   {.scene = loaded.scene.resolved, .frame_rate = 100.0, .frames = kReplayFrames, .steps_per_frame = 1},
                   loaded.simulator);
  FrameRunner runner(loaded.simulator);
  for (int frame = 1; frame <= kReplayFrames; ++frame) {
    output.write_frame(loaded.simulator, frame == 1 ? runner.first_frame() : runner.next_frame());
  }
  output.finish("done");
}

/// The reported time is that of a frame that a page requests and receives.
void replay_view(benchmark::State& state) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "sprung_viewer_benchmark";
  record(folder);
  for ([[maybe_unused]] auto _ : state) {
    ReplaySession session(folder);
    const testing::ServingServer server(session);
    testing::TestPage page(server.port());
    page.frame();
    const auto begin = Clock::now();
    for (int frame = 1; frame <= kReplayFrames; ++frame) {
      page.send({{"do", "seek"}, {"frame", frame}});
      page.frame();
    }
    state.SetIterationTime(seconds_since(begin) / kReplayFrames);
  }
  std::filesystem::remove_all(folder);
}
BENCHMARK(replay_view)->Name("replay_cloth_256")->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sprung::benchmarks
