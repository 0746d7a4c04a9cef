#include "app/body_text.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/mesh_text.h"
#include "app/step_text.h"
#include "base/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace sprung {
namespace {

constexpr int kDigits = 6;

std::string time_text(const LoadedScene& loaded) {
  const std::string stable = std::isfinite(loaded.largest_stable_step)
                                 ? "the largest stable step is " + format_upper_bound(loaded.largest_stable_step) + " s"
                                 : "every step is stable";
  return text_row("frames", fmt::format("{} at {} per second", loaded.frames, format_number(loaded.scene.frame_rate, kDigits))) +
         text_row("per frame", describe_steps(loaded) + "; " + stable);
}

/// How long a frame takes on one thread, from what cloths of 64 x 64 took on the machine of README's tables. Newton's method takes
/// longer.
std::string cost_row(const LoadedScene& loaded) {
  constexpr double kFree = 0.1e-3;      // [ms] per particle and step
  constexpr double kContact = 0.55e-3;  // in contact with a mesh
  const auto milliseconds = [](double time) { return format_number(time < 10.0 ? time : std::round(time), time < 10.0 ? 2 : 6); };
  const double moved = static_cast<double>(loaded.steps_per_frame) * loaded.simulator.network().particle_count();
  const std::string contact = loaded.simulator.environment().obstacles().empty()
                                  ? ""
                                  : fmt::format(", {} ms with all particles in contact", milliseconds(moved * kContact));
  return text_row("cost", fmt::format("estimated, one thread: {} ms a frame{}", milliseconds(moved * kFree), contact));
}

std::string material_of(const Scene& scene, const Body& body) {
  const auto found = std::ranges::find(scene.bodies, body.name, &BodyScene::name);
  return found == scene.bodies.end() ? "" : found->preset;
}

const char* shape_name(const ObstacleGeometry& geometry) {
  constexpr std::array<const char*, std::variant_size_v<ObstacleGeometry>> kNames{
      "mesh", "sequence", "sphere", "box", "capsule", "cylinder", "cone", "ellipsoid", "half-space"};
  return kNames[geometry.index()];
}

std::string shape_text(const ObstacleGeometry& geometry) {
  const auto* mesh = std::get_if<SequenceGeometry>(&geometry);
  if (mesh == nullptr) return shape_name(geometry);
  const MeshSequence& sequence = *mesh->sequence;
  return fmt::format("sequence of {} frames, {} per second from {} s{}", sequence.frames.size(),
                     format_number(sequence.frame_rate, kDigits), format_number(sequence.start, kDigits),
                     sequence.loop ? ", looped" : "");
}

const char* change_text(const Obstacle& obstacle) {
  if (obstacle.deforms()) return obstacle.motion.moves() ? "moving and deforming" : "deforming";
  return obstacle.motion.moves() ? "moving" : "static";
}

std::string mesh_row(const NamedReport& mesh) {
  const MeshReport& report = mesh.report;
  const std::vector<std::string> done = repairs(report);
  const std::string more = mesh.files > 1 ? fmt::format(" and {} more", mesh.files - 1) : "";
  std::string text = text_row("mesh", fmt::format("{}: {}{}, {} read, {}, {}, {}", mesh.obstacle, mesh.file.string(), more,
                                                  counted(report.faces_read, "triangle"), describe_closedness(report),
                                                  counted(report.components, "component"), describe_size(report.bounds)));
  if (!done.empty()) text += text_row("", fmt::format("repaired: {}", fmt::join(done, ", ")));
  return text;
}

std::string obstacle_row(const Obstacle& obstacle) {
  return text_row("obstacle", fmt::format("{}: {}, {}", obstacle.name, shape_text(obstacle.geometry), change_text(obstacle)));
}

}  // namespace

ExitCode validate(const ValidateOptions& options) {
  const LoadedScene loaded = load_scene(options.scene);
  const SpringNetwork& network = loaded.simulator.network();
  std::string text = text_row("scene", loaded.scene.file.string()) + time_text(loaded) + cost_row(loaded);
  if (const std::string solver = loaded.simulator.stretch_solver(); !solver.empty())
    text += text_row("stretch", "solved by " + solver);
  for (const Body& body : network.bodies)
    text += body_rows(network, body, material_of(loaded.scene, body)) + stiffness_rows(loaded.simulator, body);
  for (const Obstacle& obstacle : loaded.simulator.environment().obstacles()) text += obstacle_row(obstacle);
  for (const NamedReport& mesh : loaded.meshes) text += mesh_row(mesh);
  for (const std::string& warning : loaded.warnings) text += text_row("warning", warning);
  const std::size_t warnings = loaded.warnings.size();
  print_result(text + (warnings == 0 ? text_row("valid", "the scene has no errors")
                                     : fmt::format("valid, with {}\n", counted(warnings, "warning"))));
  return ExitCode::done;
}

}  // namespace sprung
