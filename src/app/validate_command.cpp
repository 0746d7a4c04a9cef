#include "app/commands.h"
#include "app/console.h"
#include "app/text/body_text.h"
#include "app/text/mesh_text.h"
#include "app/text/step_text.h"
#include "app/text/symmetry_text.h"
#include "base/format.h"
#include "base/parallel.h"
#include "simulation/frame_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sprung {
namespace {

constexpr int kDigits = 6;

std::string time_text(const LoadedScene& loaded) {
  const std::string stable = std::isfinite(loaded.largest_stable_step)
                                 ? std::string("the largest stable ") +
                                       (loaded.simulator.settings().inner_substeps > 1 ? "substep" : "step") + " is " +
                                       format_upper_bound(loaded.largest_stable_step) + " s"
                                 : "every step is stable";
  return text_row("frames", fmt::format("{} at {} per second", loaded.frames, format_number(loaded.scene.frame_rate, kDigits))) +
         text_row("per frame", describe_steps(loaded) + "; " + stable);
}

/// Two digits in ms, or in s from 10 s on. Below 0.1 ms, the rest of a frame takes longer than its steps.
std::string time_of_frame(double seconds) {
  constexpr double kShortest = 0.1e-3;
  if (seconds < kShortest) return "below 0.1 ms";
  const double digit = std::pow(10.0, std::floor(std::log10(seconds)) - 1.0);
  const double rounded = digit * std::round(seconds / digit);
  return rounded < 10.0 ? format_number(1e3 * rounded, kDigits) + " ms" : format_number(rounded, kDigits) + " s";
}

std::string cost_row(const FrameCost& cost, int threads) {
  if (cost.failure) return text_row("cost", "unknown: the simulation diverges in its first steps");
  const std::string free =
      cost.steps > 0 ? fmt::format("{} a frame in motion ({} measured)", time_of_frame(cost.free), counted(cost.steps, "step"))
                     : fmt::format("more than {} a frame in motion (a step takes over a second)", time_of_frame(cost.free));
  const std::string full =
      cost.full > cost.free
          ? fmt::format(", {} {} (estimated)", cost.can_touch ? "in full contact" : "with the stretch limit at work",
                        time_of_frame(cost.full))
          : "";
  return text_row("cost", fmt::format("free {}{}, {}", free, full, counted(threads, "thread")));
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

std::string contents(const LoadedScene& loaded) {
  const SpringNetwork& network = loaded.simulator.network();
  std::string text;
  if (const std::string solver = loaded.simulator.stretch_solver(); !solver.empty())
    text += text_row("stretch", "solved by " + solver);
  for (const Body& body : network.bodies)
    text += body_rows(network, body, material_of(loaded.scene, body)) + stiffness_rows(loaded.simulator, body);
  for (const Obstacle& obstacle : loaded.simulator.obstacles()) text += obstacle_row(obstacle);
  for (const NamedReport& mesh : loaded.meshes) text += mesh_row(mesh);
  for (const StepAdjustment& adjustment : loaded.adjustments) text += text_row("adjusted", describe(adjustment));
  for (const std::string& note : loaded.simulator.notes()) text += text_row("start", note);
  return text;
}

std::string verdict(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) text += text_row("warning", warning);
  return text + (warnings.empty() ? text_row("valid", "the scene has no errors")
                                  : fmt::format("valid, with {}\n", counted(warnings.size(), "warning")));
}

}  // namespace

ExitCode validate(const ValidateOptions& options) {
  const int threads = thread_count(options.threads);
  const ThreadLimit limit(threads);
  LoadedScene loaded = load_scene(options.scene);
  const std::string head = text_row("scene", loaded.scene.file.string()) + time_text(loaded);
  // Before the measurement, which advances the simulator.
  const std::string rows = contents(loaded);
  const std::string symmetry = symmetry_row(loaded.simulator);
  const FrameCost cost = measure_frame_cost(loaded.simulator, loaded.simulator.settings().steps_per_frame, threads);
  if (cost.failure) loaded.warnings.push_back(*cost.failure);

  const bool loses_symmetry = cost.can_touch || loaded.simulator.settings().stretch_limit;
  print_result(head + cost_row(cost, threads) + rows + (loses_symmetry ? symmetry : "") + verdict(loaded.warnings));
  return ExitCode::done;
}

}  // namespace sprung
