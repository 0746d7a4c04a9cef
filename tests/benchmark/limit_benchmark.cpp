// Cloths and ropes that the stretch limit alone carries: time of a frame and largest stretch. Bullet's soft body, with one step of
// 20 passes a frame, is measured in the same run.
#include "base/parallel.h"
#include "benchmark/bullet_hanging.h"
#include "benchmark/processor_time.h"
#include "scene/building/scene_builder.h"
#include "simulation/simulator.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sprung::benchmarks {
namespace {

constexpr int kFrames = 300;
constexpr int kFirstFrame = 30;  // stretch is measured from this frame on: hanging bodies have settled
constexpr double kFrameRate = 60.0;
constexpr double kGravity = 9.81;
constexpr int kBulletPasses = 20;

enum Motion : std::uint8_t { hanging, swinging };

/// For cloths with passes: structural and shear springs may neither stretch nor shrink, with a tolerance of 1 %. Bullet's links,
/// which include bend springs, limit both too. Small steps of one pass reach the tolerance sooner than larger steps of several
/// passes.
const StretchLimitSettings kClothLimit{.max_stretch = 0.0,
                                       .max_compression = 0.0,
                                       .kinds = {SpringKind::structural, SpringKind::shear},
                                       .iterations = 1,
                                       .tolerance = 0.01,
                                       .tethers = true,
                                       .solver = StretchLimitSettings::Solver::gauss_seidel};

/// For cloths with a global solve: the same tolerance for stretch alone. Limits of compression need passes.
const StretchLimitSettings kSolvedClothLimit{.max_stretch = 0.0, .tolerance = 0.01, .solver = StretchLimitSettings::Solver::newton};

const StretchLimitSettings& cloth_limit(bool solved) { return solved ? kSolvedClothLimit : kClothLimit; }

/// For ropes: a tolerance of 0.4 %, for which a global solve needs no small steps.
const StretchLimitSettings kRopeLimit{.max_stretch = 0.0, .tolerance = 0.004, .solver = StretchLimitSettings::Solver::automatic};

Scene scene_of(BodyScene body, const StretchLimitSettings& limit) {
  Scene scene;
  scene.duration = kFrames / kFrameRate;
  scene.frame_rate = kFrameRate;
  scene.settings.gravity = {0.0, -kGravity, 0.0};
  scene.settings.stretch_limit = limit;
  scene.bodies.push_back(std::move(body));
  return scene;
}

BodyScene body_of(BodyShapeScene shape, double mass, const std::vector<std::string>& pinned_corners) {
  BodyScene body;
  body.name = "body";
  body.shape = std::move(shape);
  body.mass = {.kind = MassScene::Kind::body, .value = mass};
  body.springs.structural = SpringMaterial{};
  body.pins.push_back({.where = CornersSelector{pinned_corners}, .motion = {}});
  return body;
}

/// A cloth of 1 m and 0.2 kg that hangs by two corners, or lies level.
Scene cloth(Index side, Motion motion, const StretchLimitSettings& limit) {
  BodyScene body = body_of(ClothShape{.resolution = {side, side}}, 0.2, {"min_max", "max_max"});
  body.springs.shear = SpringMaterial{};
  body.springs.bend = SpringMaterial{};
  if (motion == swinging) body.place.rotation.x() = -90.0;
  return scene_of(std::move(body), limit);
}

/// A rope of 1 m and 0.1 kg that hangs by one end, or lies level.
Scene rope(Index particles, Motion motion) {
  const Vector3 end = motion == swinging ? Vector3(1.0, 0.0, 0.0) : Vector3(0.0, -1.0, 0.0);
  return scene_of(body_of(RopeShape{.points = {Vector3::Zero(), end}, .particles = particles, .length = {}}, 0.1, {"from"}),
                  kRopeLimit);
}

/// The largest stretch of a structural spring.
double stretch(const SpringNetwork& network, const Points& x) {
  const Springs& springs = network.springs;
  double most = 0.0;
  for (Index s = 0; s < springs.count(); ++s) {
    if (springs.kind[s] != SpringKind::structural) continue;
    most = std::max(most, (x.col(springs.first[s]) - x.col(springs.second[s])).norm() / springs.rest_length[s] - 1.0);
  }
  return most;
}

struct Measured {
  double seconds = 0.0;  ///< a frame
  double worst = 0.0;    ///< largest stretch after a frame from kFirstFrame on
  double end = 0.0;      ///< stretch after the last frame
};

template <class StepFrame, class Positions>
Measured run(const SpringNetwork& network, const StepFrame& step_frame, const Positions& positions) {
  Measured measured;
  for (int frame = 1; frame <= kFrames; ++frame) {
    const double begin = processor_time();
    step_frame();
    measured.seconds += (processor_time() - begin) / kFrames;
    measured.end = stretch(network, positions());
    if (frame >= kFirstFrame) measured.worst = std::max(measured.worst, measured.end);
  }
  return measured;
}

Measured run_sprung(const BuiltScene& built) {
  Simulator simulator(built.network, built.settings);
  const auto step_frame = [&] {
    for (int step = 0; step < built.settings.steps_per_frame; ++step) simulator.step();
  };
  return run(built.network, step_frame, [&]() -> const Points& { return simulator.positions(); });
}

Measured run_bullet(const SpringNetwork& network) {
  BulletHanging bullet(network, kGravity, 1.0 / kFrameRate, kBulletPasses);
  return run(
      network, [&] { bullet.step_frame(); }, [&] { return bullet.positions(); });
}

/// The reported time is Sprung's time a frame.
Measured report(benchmark::State& state, const BuiltScene& built) {
  const Measured sprung = run_sprung(built);
  state.SetIterationTime(sprung.seconds);
  state.counters["worst_%"] = 100.0 * sprung.worst;
  state.counters["end_%"] = 100.0 * sprung.end;
  state.counters["steps"] = built.settings.steps_per_frame;
  state.counters["ns_a_particle"] = 1e9 * sprung.seconds / built.network.particle_count();
  return sprung;
}

/// Arguments: particles along a side, motion, whether a global solve enforces the limit. One thread.
void cloth_against_bullet(benchmark::State& state) {
  const ThreadLimit one_thread(1);
  const BuiltScene built =
      build_scene(cloth(static_cast<Index>(state.range(0)), static_cast<Motion>(state.range(1)), cloth_limit(state.range(2) != 0)));
  for ([[maybe_unused]] auto _ : state) {
    const Measured sprung = report(state, built);
    const Measured bullet = run_bullet(built.network);
    state.counters["bullet_ms"] = 1e3 * bullet.seconds;
    state.counters["of_bullet"] = sprung.seconds / bullet.seconds;
    state.counters["bullet_worst_%"] = 100.0 * bullet.worst;
  }
}

/// Arguments: particles, motion. One thread.
void limited_rope(benchmark::State& state) {
  const ThreadLimit one_thread(1);
  const BuiltScene built = build_scene(rope(static_cast<Index>(state.range(0)), static_cast<Motion>(state.range(1))));
  for ([[maybe_unused]] auto _ : state) report(state, built);
}

/// Kinetic and potential energy [J] after `frames` frames. The chosen step is divided by `divisor`, and each step may have up to
/// `max_substeps` substeps.
double energy_after(const BuiltScene& built, int frames, int divisor, int max_substeps) {
  SimulatorSettings settings = built.settings;
  settings.step /= divisor;
  settings.max_substeps = max_substeps;
  Simulator simulator(built.network, settings);
  for (int step = 0; step < frames * built.settings.steps_per_frame * divisor; ++step) simulator.step();
  return 0.5 * built.network.masses.dot(simulator.state().v.colwise().squaredNorm().transpose()) + simulator.gravity_energy();
}

/// The error of the energy of a cloth after 2 s of swinging, compared with a tenth of the step, as a fraction of the energy that a
/// fall by half the cloth's length releases. Arguments: particles along a side, whether a global solve enforces the limit.
void swing_energy(benchmark::State& state) {
  constexpr int kTwoSeconds = 120;
  const BuiltScene built = build_scene(cloth(static_cast<Index>(state.range(0)), swinging, cloth_limit(state.range(1) != 0)));
  const double fall = built.network.masses.sum() * kGravity * 0.5;
  for ([[maybe_unused]] auto _ : state) {
    const double energy = energy_after(built, kTwoSeconds, 1, built.settings.max_substeps);
    state.counters["off_%"] = 100.0 * (energy - energy_after(built, kTwoSeconds, 10, 1)) / fall;
  }
}

BENCHMARK(swing_energy)
    ->ArgNames({"side", "newton"})
    ->Args({64, 0})
    ->Args({64, 1})
    ->Args({128, 1})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);
BENCHMARK(cloth_against_bullet)
    ->ArgNames({"side", "swinging", "newton"})
    ->ArgsProduct({{64, 128, 256}, {hanging, swinging}, {0, 1}})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(limited_rope)
    ->ArgNames({"particles", "swinging"})
    ->ArgsProduct({{1000, 100000}, {hanging, swinging}})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sprung::benchmarks
