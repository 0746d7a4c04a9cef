#include "viewer/live/live_texts.h"

#include "output/run_recorder.h"
#include "viewer/live/shown_simulator.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace sprung {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json bodies_of(const SpringNetwork& network) {
  Json bodies = Json::array();
  for (const Body& body : network.bodies) {
    bodies.push_back({{"name", body.name}, {"first", body.first_particle}, {"count", body.particle_count}});
  }
  return bodies;
}

Json obstacles_of(const Simulator& simulator) {
  Json obstacles = Json::array();
  for (const Obstacle& obstacle : simulator.obstacles()) {
    obstacles.push_back({{"name", obstacle.name}, {"motion", kObstacleMotionNames[static_cast<std::size_t>(motion_of(obstacle))]}});
  }
  return obstacles;
}

/// Masses of particles [kg], where there are few enough to be drawn each; otherwise empty.
Json masses_of(const SpringNetwork& network) {
  constexpr Index kMostDrawn = 300;
  if (network.particle_count() > kMostDrawn) return Json::array();
  return std::vector<double>(network.masses.begin(), network.masses.end());
}

/// The text beside a scene, as of a lesson: NAME.txt of NAME.json.
Json lesson_of(const std::string& scene_file) {
  std::ifstream file(std::filesystem::path(scene_file).replace_extension(".txt"));
  return std::string(std::istreambuf_iterator<char>(file), {});
}

/// The body of a failure and, of the network, its particle and spring.
void add_location(const StepFailure& failure, const SpringNetwork& network, Json& message) {
  message["springs"] = Json::array();
  for (const Body& body : network.bodies) {
    if (body.name != failure.body) continue;
    message["body"] = body.name;
    if (failure.particle != kNone) message["particle"] = body.first_particle + failure.particle;
    if (failure.spring != kNone) message["springs"].push_back(body.first_spring + failure.spring);
  }
}

}  // namespace

std::string scene_text(std::uint32_t number, std::uint32_t generation, bool live, const LiveRun& run) {
  const LoadedScene& loaded = run.loaded();
  const Json scene = Json::parse(loaded.scene.resolved);
  return text_of({{"type", "scene"},
                  {"run", number},
                  {"generation", generation},
                  {"title", std::filesystem::path(run.source().file).filename().string()},
                  {"lesson", lesson_of(run.source().file)},
                  {"integrator", integrator_name(loaded.simulator)},
                  {"step", loaded.simulator.settings().step},
                  {"steps_per_frame", loaded.simulator.settings().steps_per_frame},
                  {"frame_rate", loaded.scene.frame_rate},
                  {"frames", loaded.frames},
                  {"largest_stable_step", or_null(loaded.largest_stable_step)},
                  {"live", live},
                  {"complete", true},
                  {"scene", scene},
                  {"changed", Json::parse(run.changed_scene())},
                  {"warnings", loaded.warnings},
                  {"masses", masses_of(loaded.simulator.network())},
                  {"bodies", bodies_of(loaded.simulator.network())},
                  {"obstacles", obstacles_of(loaded.simulator)},
                  {"forces", loaded.simulator.settings().record_contact_forces}});
}

std::string watched_text(std::uint32_t generation, const std::string& title, const Simulator& simulator) {
  const SimulatorSettings& settings = simulator.settings();
  return text_of({{"type", "scene"},
                  {"run", 0},
                  {"generation", generation},
                  {"title", title},
                  {"lesson", ""},
                  {"integrator", integrator_name(simulator)},
                  {"step", settings.step},
                  {"steps_per_frame", settings.steps_per_frame},
                  {"frame_rate", 1.0 / (settings.step * settings.steps_per_frame)},
                  {"frames", 1},
                  {"largest_stable_step", Json()},
                  {"live", generation > 1},
                  {"complete", true},
                  {"scene", Json::object()},
                  {"changed", Json::object()},
                  {"warnings", simulator.warnings()},
                  {"masses", masses_of(simulator.network())},
                  {"bodies", bodies_of(simulator.network())},
                  {"obstacles", obstacles_of(simulator)},
                  {"forces", simulator.settings().record_contact_forces}});
}

std::string diverged_text(std::uint32_t number, std::uint32_t generation, const LiveRun& run) {
  const StepFailure& failure = *run.failure();
  Json message{{"type", "diverged"}, {"run", number}, {"generation", generation}, {"text", StepError(failure).what()}};
  add_location(failure, run.simulator().network(), message);
  message["stable_step"] = failure.smaller_step ? Json(*failure.smaller_step) : Json();
  return text_of(message);
}

std::string changed_text(std::uint32_t number, const LiveRun& run, const std::string& initial_state) {
  return text_of({{"type", "changed"}, {"run", number}, {"changed", Json::parse(run.changed_scene(initial_state))}});
}

}  // namespace sprung
