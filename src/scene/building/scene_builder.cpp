#include "scene/building/scene_builder.h"

#include "base/format.h"
#include "base/grouped_warnings.h"
#include "base/machine/machine_memory.h"
#include "base/problem_list.h"
#include "geometry/mesh/mesh_faults.h"
#include "geometry/mesh/weld.h"
#include "network/network_builder.h"
#include "network/spring_pieces.h"
#include "scene/building/attachment_resolver.h"
#include "scene/building/body_builder.h"
#include "scene/building/initial_state.h"
#include "scene/building/memory_check.h"
#include "scene/building/obstacle_builder.h"
#include "scene/building/pin_resolver.h"
#include "scene/building/strength_scatter.h"
#include "scene/building/unlikely_settings.h"
#include "scene/json/json_text.h"
#include "scene/step_choice/step_choice.h"
#include "simulation/step/frame_steps.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace sprung {
namespace {

/// The bodies whose shape is valid in the text. Springs and pins that depend on invalid text are left out.
std::vector<BodyScene> valid_bodies(const Scene& scene, const TextProblems& known) {
  std::vector<BodyScene> bodies;
  for (BodyScene body : scene.bodies) {
    const std::string key = join_path("bodies", body.name);
    if (known.affect(key + ".shape")) continue;
    if (known.affect(key + ".springs")) {
      body.springs = {};
      body.spring_groups.clear();
    }
    if (body.mass.value == 0.0) body.mass = {.kind = MassScene::Kind::body, .value = 1.0};
    if (known.affect(key + ".place")) {
      body.pins.clear();
      body.point_masses.clear();
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

/// Adjusts a body that has a material, so that a few short edges do not bound an automatic step.
void adjust(const Scene& scene, const BodyScene& body, BodyShape& shape, std::vector<StepAdjustment>& adjustments) {
  if (scene.step || body.preset.empty() || std::holds_alternative<ImplicitEulerSettings>(scene.settings.integrator)) return;
  auto adjustment = adjust_for_step(shape, body.preset_mass ? scene.mass_scaling : 0.0);
  if (!adjustment) return;
  adjustment->body = body.name;
  adjustments.push_back(std::move(*adjustment));
}

void add_body(const Scene& scene, const BodyScene& body, const MeshFinder& finder, NetworkBuilder& network,
              AttachmentResolver& attachments, BuiltScene& into, std::vector<Problem>& problems) {
  auto built = build_body(scene, body, finder, problems);
  if (!built) return;
  const auto& limited = scene.limited_bodies;
  built->shape.has_material_dampers.fill(!body.preset.empty());
  if (scene.air_of_materials && !body.preset.empty()) built->shape.drag = drag_in_air(built->shape, body.diameter);
  adjust(scene, body, built->shape, into.adjustments);
  scatter_strength(scene, body, built->shape);
  built->shape.stretch_limited = limited.empty() || std::ranges::find(limited, body.name) != limited.end();
  std::vector<Pin> pins = resolve_pins(scene, body, *built, problems);
  const Index first = network.add_body(body.name, built->shape, body.material, body.contact);
  attachments.note_body(body, *built, first);
  if (built->source) into.sources[body.name] = std::make_shared<const ObjSource>(std::move(*built->source));
  for (Pin& pin : pins) {
    for (Index& particle : pin.particles) particle += first;
    network.add_pin(std::move(pin));
  }
}

/// The network; none if a body or the scene's text has problems.
std::optional<SpringNetwork> build_network(const Scene& scene, const MeshFinder& finder, const TextProblems& known,
                                           BuiltScene& into, std::vector<Problem>& problems) {
  const std::vector<BodyScene> bodies = valid_bodies(scene, known);
  check_memory(bodies, machine_memory(), problems);
  if (!problems.empty()) return std::nullopt;
  NetworkBuilder network;
  AttachmentResolver attachments(scene, known, problems);
  for (const BodyScene& body : bodies) add_body(scene, body, finder, network, attachments, into, problems);
  attachments.add_to(network);
  if (!problems.empty() || !known.only_unknown_keys) return std::nullopt;
  try {
    return network.build();
  } catch (const InputError& error) {
    problems = error.problems();
  }
  return std::nullopt;
}

/// Sets the file of problems that have none: those of the scene.
void name_file(const std::string& file, std::vector<Problem>& problems) {
  for (Problem& problem : problems) {
    if (problem.file.empty()) problem.file = file;
  }
}

/// The vertices that keep a seam open if the vertices of the body's mesh are welded within `distance` [m].
std::vector<Index> open_after_weld(const Points& positions, PolygonFaces faces, double distance) {
  const std::vector<Index> group_of = coincident_groups(positions, distance);
  for (Index& vertex : faces.vertex) vertex = group_of[vertex];
  return vertices_on_border_edges(positions, faces, distance);
}

/// What to do with pieces of a mesh that touch. Where T-vertices keep the seam open, a weld alone would only cause
/// their warning.
std::string weld_remedy(const SpringNetwork& network, const Body& body, const SpringPieces& pieces) {
  if (pieces.touch_distance == 0.0) return "Merge vertices at the same place in the mesh.";
  const std::string distance = "1e" + std::to_string(std::lround(std::log10(pieces.touch_distance)));
  const std::string weld = "Weld vertices within " + distance + " m with \"weld\": " + distance + " in its shape";
  const Points positions = network.positions.middleCols(body.first_particle, body.particle_count);
  const std::vector<Index> open = open_after_weld(positions, body.surface.faces, pieces.touch_distance);
  if (open.empty()) return weld + ", which leaves " + counted(static_cast<std::size_t>(pieces.count_welded), "piece") + ".";
  return "In the modelling program, add the missing vertices to the edges of the seam, at " + counted(open.size(), "place") +
         ", first at " + vector_text(positions.col(open.front()), 3) + ". " + weld + ".";
}

std::string join_remedy(const SpringNetwork& network, const Body& body, const SpringPieces& pieces, bool is_mesh) {
  if (is_mesh) return weld_remedy(network, body, pieces);
  if (!body.cells.tetrahedra.empty()) return "Merge nodes at the same place in the file (Gmsh: Coherence Mesh).";
  return "Join them by springs.";
}

std::vector<std::string> pieces_warnings(const SpringNetwork& network, const Body& body, const SpringPieces& pieces, bool is_mesh) {
  if (body.particle_count < 2) return {};
  if (pieces.count == 0) return {"no springs, so the particles move independently. Give it \"springs\" or a \"material\"."};
  std::vector<std::string> warnings;
  if (pieces.alone > 0) {
    warnings.push_back(counted(pieces.alone, "particle") +
                       " without a spring, which nothing holds to the rest. Add lines or faces to the mesh that lead there, or "
                       "remove such vertices.");
  }
  if (pieces.touch) {
    warnings.push_back(std::to_string(pieces.count + pieces.alone) +
                       " pieces that no spring joins, though some touch: they fall apart. " +
                       join_remedy(network, body, pieces, is_mesh));
  }
  return warnings;
}

std::vector<std::string> source_warnings(const ObjSource& source) {
  std::vector<std::string> warnings;
  const auto warn = [&](const std::vector<std::string>& names, const std::string& text) {
    if (!names.empty()) warnings.push_back("the mesh names the material " + names_text("file", "files", names) + text);
  };
  const MaterialFiles& materials = source.materials;
  warn(materials.missing,
       ", which Sprung does not find and does not copy beside the frames. Put it there, or remove the line mtllib.");
  warn(materials.unusual,
       ", which Sprung does not copy: another file has the name there, or the name has a # or ends in .obj. Rename it.");
  warn(materials.outside,
       ", outside of its folder. The copies are beside the frames, which still name the place outside. Move "
       "it beside the mesh, and change the line mtllib.");
  if (source.file.has_given_normals() && !source.file.writes_normals()) {
    warnings.push_back(
        "the normals (vn) of the mesh are written as they are, though they go stale as the body deforms. Write them "
        "anew with \"normals\": true of the body, or remove them from the mesh.");
  }
  return warnings;
}

/// Sets the remedies of bodies too.
std::vector<std::string> warnings_of(const Scene& scene, BuiltScene& built) {
  GroupedWarnings bodies("body", "bodies");
  for (const Body& body : built.network.bodies) {
    const auto source = built.sources.find(body.name);
    const bool is_mesh = source != built.sources.end();
    const SpringPieces pieces = spring_pieces(built.network, body);
    for (const std::string& text : pieces_warnings(built.network, body, pieces, is_mesh)) bodies.add(body.name, text);
    if (!is_mesh) continue;
    if (pieces.touch) built.weld_remedies[body.name] = weld_remedy(built.network, body, pieces);
    for (const std::string& text : source_warnings(*source->second)) bodies.add(body.name, text);
  }
  GroupedWarnings obstacles("obstacle", "obstacles");
  for (const NamedReport& mesh : built.meshes) {
    for (const std::string& note : mesh.report.notes) obstacles.add(mesh.obstacle, note);
  }
  note_unusual_sizes(scene, built, bodies, obstacles);
  note_unusual_densities(scene, built.network, bodies);
  note_unused_springs(scene, built.network, bodies);
  note_mesh_faults(scene, built.network, bodies);
  note_thick_bodies(built.network, bodies);
  note_wind_along_sheets(scene, built.network, bodies);
  std::vector<std::string> warnings = bodies.lines();
  std::ranges::move(obstacles.lines(), std::back_inserter(warnings));
  return warnings;
}

}  // namespace

BuiltScene build_scene(const Scene& scene, const std::vector<std::filesystem::path>& mesh_paths, const TextProblems& known) {
  std::vector<Problem> problems;
  const MeshFinder finder(scene.file, mesh_paths);
  BuiltScene built;
  auto network = build_network(scene, finder, known, built, problems);
  name_file(scene.file.string(), problems);

  ObstacleBuilder obstacles(scene, finder, problems);
  for (const ObstacleScene& obstacle : scene.obstacles) {
    if (known.affect(join_path("obstacles", obstacle.name) + ".shape")) continue;
    if (auto made = obstacles.build(obstacle)) built.obstacles.push_back(std::move(*made));
  }
  built.meshes = obstacles.reports();

  built.settings = scene.settings;
  built.frames = frame_count(scene.duration, scene.frame_rate);
  std::optional<std::string> step_warning;
  if (network) {
    StepChoice choice = choose_step(scene, *network, problems);
    built.settings.step = choice.step;
    built.settings.inner_substeps = choice.inner_substeps;
    built.settings.max_substeps = choice.max_substeps;
    built.settings.steps_per_frame = choice.steps_per_frame;
    built.largest_stable_step = choice.largest_stable;
    step_warning = std::move(choice.warning);
    built.network = std::move(*network);
  }
  if (network && !scene.initial_state.empty()) begin_as_run_ended(scene, built, problems);
  problems.insert(problems.begin(), known.all.begin(), known.all.end());
  if (!problems.empty()) throw InputError(std::move(problems));
  const std::vector<std::string> more = warnings_of(scene, built);
  built.warnings.insert(built.warnings.end(), more.begin(), more.end());
  if (step_warning) built.warnings.push_back(std::move(*step_warning));
  return built;
}

}  // namespace sprung
