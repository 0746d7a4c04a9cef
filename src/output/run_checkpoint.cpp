#include "output/run_checkpoint.h"

#include "base/error.h"
#include "base/files/fingerprint.h"
#include "base/format.h"
#include "collision/shapes/obstacle.h"
#include "simulation/model.h"
#include "simulation/simulator.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>
#include <utility>

namespace sprung {

template <Same<NewtonFrom> S, class Visit>
void visit_members(S& n, const Visit& visit) {
  visit(n.body, n.step);
}
template <Same<TornFaces> S, class Visit>
void visit_members(S& t, const Visit& visit) {
  visit(t.body, t.frame, t.faces);
}
template <Same<BrokenAttachment> S, class Visit>
void visit_members(S& b, const Visit& visit) {
  visit(b.name, b.body, b.particle, b.step);
}
template <Same<RunProgress> S, class Visit>
void visit_members(S& p, const Visit& visit) {
  visit(p.outcome, p.frames_written, p.steps, p.substeps, p.smallest_step, p.limit_solves, p.newton_from, p.torn_faces,
        p.broken_attachments, p.wall_seconds, p.warnings);
}
template <Same<RunIdentity> S, class Visit>
void visit_members(S& i, const Visit& visit) {
  visit(i.keys, i.fingerprints);
}
template <Same<RunCheckpoint> S, class Visit>
void visit_members(S& c, const Visit& visit) {
  visit(c.identity, c.files, c.progress, c.monitor, c.record_size, c.diagnostics_size, c.forces_size);
}

namespace {

using Json = nlohmann::ordered_json;

// A list of all differences helps nobody if the scene is another one.
constexpr std::size_t kNamedDifferences = 6;

constexpr std::string_view kRemedy = "; run this scene into another folder, or replace the run with --overwrite";

/// Results do not depend on where files lie, and frames that are there do not on how many follow.
bool belongs_to_identity(const std::string& key) {
  constexpr std::array<std::string_view, 5> kLeftOut{"duration", "file", "files", "initial_state", "$schema"};
  const std::string last = key.substr(key.rfind('.') + 1);
  return std::ranges::find(kLeftOut, last.substr(0, last.find('['))) == kLeftOut.end();
}

/// The text of a value: 30 and 30.0 are the same number.
std::string text_of(const Json& value) {
  if (value.is_number()) return format_number(value.get<double>());
  if (!value.is_array()) return value.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string text(1, '[');
  for (const Json& entry : value) {
    if (text.size() > 1) text += ',';
    text += text_of(entry);
  }
  text += ']';
  return text;
}

std::string names_in_order(const auto& named) {
  std::string text;
  for (const auto& entry : named) {
    if (!text.empty()) text += ", ";
    text += '"';
    text += entry.name;
    text += '"';
  }
  return text;
}

void add_keys(const Json& json, const std::string& path, std::map<std::string, std::string>& keys) {
  if (json.is_object() && !json.empty()) {
    for (const auto& [key, value] : json.items()) add_keys(value, path.empty() ? key : path + "." + key, keys);
  } else if (json.is_array() && !json.empty() && json.front().is_structured()) {
    for (std::size_t k = 0; k < json.size(); ++k) add_keys(json[k], path + "[" + std::to_string(k) + "]", keys);
  } else if (belongs_to_identity(path)) {
    keys[path] = text_of(json);
  }
}

template <class... Values>
std::uint64_t fingerprint_of_all(const Values&... values) {
  Fingerprint fingerprint;
  (fingerprint.add(to_bytes(values)), ...);
  return fingerprint.value();
}

std::uint64_t fingerprint_of_body(const Model& model, const Body& body) {
  const SpringNetwork& network = model.network();
  const SimulationState& start = model.initial_state();
  const Springs& springs = network.springs;
  const PolygonFaces& faces = body.surface.faces;
  std::vector<Index> held;  // by pins, and the number of particles of each pin
  for (const Pin& pin : network.pins) {
    const std::size_t count = held.size();
    std::ranges::copy_if(pin.particles, std::back_inserter(held),
                         [&](Index i) { return i >= body.first_particle && i < body.first_particle + body.particle_count; });
    held.push_back(static_cast<Index>(held.size() - count));
  }
  const auto of_body = [&](const auto& list) {
    return std::vector(list.begin() + body.first_spring, list.begin() + body.first_spring + body.spring_count);
  };
  return fingerprint_of_all(Points(network.positions.middleCols(body.first_particle, body.particle_count)),
                            Points(start.x.middleCols(body.first_particle, body.particle_count)),
                            Points(start.v.middleCols(body.first_particle, body.particle_count)),
                            Scalars(network.masses.segment(body.first_particle, body.particle_count)), of_body(springs.first),
                            of_body(springs.second), of_body(springs.rest_length), of_body(springs.stiffness),
                            of_body(springs.damping), faces.corner_begin, faces.vertex, faces.texcoord, faces.texcoords,
                            faces.groups, faces.group_begin, held);
}

void add(const std::string& difference, std::vector<std::string>& all) {
  if (std::ranges::find(all, difference) == all.end()) all.push_back(difference);
}

std::vector<std::string> differences(const RunIdentity& before, const RunIdentity& now) {
  std::vector<std::string> all;
  for (const auto& [key, value] : before.keys) {
    const auto present = now.keys.find(key);
    if (present == now.keys.end()) {
      add(key + " = " + value + " is missing", all);
    } else if (present->second != value) {
      add(key + " is " + present->second + ", was " + value, all);
    }
  }
  for (const auto& [key, value] : now.keys) {
    if (!before.keys.contains(key)) add(key + " = " + value + " is new", all);
  }
  if (!all.empty()) return all;  // what was built differs for these reasons
  for (const auto& [name, fingerprint] : before.fingerprints) {
    const auto present = now.fingerprints.find(name);
    if (present != now.fingerprints.end() && present->second != fingerprint)
      add("the mesh, or the state in \"initial_state\", of " + name + " is another one", all);
  }
  return all;
}

[[noreturn]] void fail(const OutputFolder& folder, const std::string& reason) {
  throw FileError("resume the run", folder.path().string(), reason + std::string(kRemedy));
}

void expect_same(const OutputFolder& folder, const RunIdentity& before, const RunIdentity& now) {
  const std::vector<std::string> found = differences(before, now);
  if (found.empty()) return;
  std::string text;
  for (std::size_t k = 0; k < std::min(found.size(), kNamedDifferences); ++k) text += (k > 0 ? "; " : "") + found[k];
  if (found.size() > kNamedDifferences) text += "; and " + std::to_string(found.size() - kNamedDifferences) + " more";
  fail(folder, "it is the run of another scene: " + text);
}

}  // namespace

std::map<std::string, std::uint64_t> fingerprints_of(const Model& model) {
  std::map<std::string, std::uint64_t> fingerprints;
  for (const Body& body : model.network().bodies) fingerprints["body \"" + body.name + "\""] = fingerprint_of_body(model, body);
  for (const Obstacle& obstacle : model.obstacles().obstacles()) {
    fingerprints["obstacle \"" + obstacle.name + "\""] = fingerprint_of_shape(obstacle);
  }
  return fingerprints;
}

RunIdentity identity_of(const std::string& scene, const Simulator& simulator) {
  const Model& model = *simulator.model();
  RunIdentity identity{.keys = {}, .fingerprints = fingerprints_of(model)};
  if (scene.empty()) return identity;
  add_keys(Json::parse(scene), "", identity.keys);
  identity.keys["the order of bodies"] = names_in_order(model.network().bodies);
  identity.keys["the order of obstacles"] = names_in_order(model.obstacles().obstacles());
  return identity;
}

ResumePoint find_resume_point(const OutputFolder& folder, const RunFacts& facts, const Simulator& simulator) {
  if (folder.is_empty()) return {};
  std::error_code ignored;
  const bool has_checkpoint = std::filesystem::exists(folder.path() / kCheckpointFile, ignored);
  auto run = written_run(folder.path() / kRunSummaryFile);
  if (!run && !has_checkpoint) {
    throw FileError("resume the run", folder.path().string(), "it has files but no run of sprung; choose another folder");
  }
  if (!run) run = WrittenRun{};  // the checkpoint has all that is needed
  const RunIdentity now = identity_of(facts.scene, simulator);
  ResumePoint point;
  point.has_run = true;
  point.frames_written = run->frames_written;
  if (has_checkpoint) {
    point.checkpoint = read_checkpoint(folder.path() / kCheckpointFile, "run the scene again with --overwrite");
    expect_same(folder, run_checkpoint(*point.checkpoint, folder).identity, now);
  } else if (!run->scene.empty()) {
    RunIdentity before{.keys = {}, .fingerprints = now.fingerprints};
    for (const char* order : {"the order of bodies", "the order of obstacles"}) before.keys[order] = now.keys.at(order);
    add_keys(Json::parse(run->scene), "", before.keys);
    expect_same(folder, before, now);
  }
  // A run that was killed after its last frame has no outcome yet. One that was killed while it was removed has lost this file.
  const bool is_whole = std::filesystem::exists(folder.path() / kDiagnosticsFile, ignored);
  point.is_complete =
      is_whole && (run->frames_written > facts.frames || (run->frames_written == facts.frames && run->outcome == "done"));
  if (!point.is_complete && !has_checkpoint && run->frames_written > 0 && run->outcome != "running") {
    fail(folder, "its " + std::to_string(run->frames_written) + " frames have no " + kCheckpointFile + " to go on from");
  }
  return point;
}

RunCheckpoint run_checkpoint(const Checkpoint& checkpoint, const OutputFolder& folder) {
  RunCheckpoint run;
  try {
    from_bytes(checkpoint.run, run);
  } catch (const BytesError&) {
    fail(folder, std::string(kCheckpointFile) + " is not the checkpoint of a run");
  }
  return run;
}

std::string bytes_of(const RunCheckpoint& checkpoint) { return to_bytes(checkpoint); }

}  // namespace sprung
