#include "scene/building/initial_state.h"

#include "base/format.h"
#include "base/grouped_warnings.h"
#include "output/recorded_run.h"
#include "scene/json/nearest_name.h"
#include "simulation/checkpoint.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sprung {
namespace {

namespace fs = std::filesystem;

/// The end of a run.
struct FormerRun {
  std::vector<NamedCount> bodies;  ///< in the order of their particles and springs
  Points positions;
  Points velocities;                 ///< 3 x 0 if they are not known
  std::vector<double> rest_lengths;  ///< empty: not known, or none may change
  std::vector<char> broken;          ///< empty: none is
  Slip slip;                         ///< empty if it is not known
  std::vector<NamedCount> obstacles{};
};

FormerRun former_run(Checkpoint checkpoint) {
  SimulationState& state = checkpoint.state;
  return {.bodies = std::move(checkpoint.bodies),
          .positions = std::move(state.x),
          .velocities = std::move(state.v),
          .rest_lengths = std::move(state.springs.rest_lengths),
          .broken = std::move(state.springs.broken),
          .slip = std::move(state.contact.slip),
          .obstacles = std::move(checkpoint.obstacles)};
}

FormerRun former_run(const RecordedRun& run) {
  RecordedFrame last = run.frame(run.frames());
  FormerRun former{.bodies = {},
                   .positions = std::move(last.positions),
                   .velocities = std::move(last.velocities),
                   .rest_lengths = {},
                   .broken = std::move(last.broken),
                   .slip = {}};
  const Edges& ends = run.model().springs.ends;
  for (const RecordedBody& body : run.model().bodies) {
    std::vector<Index> its_ends;
    for (Eigen::Index s = 0; s < ends.cols(); ++s) {
      const Index end = ends(0, s) - body.first_particle;
      if (end < 0 || end >= body.particle_count) continue;
      its_ends.push_back(end);
      its_ends.push_back(ends(1, s) - body.first_particle);
    }
    former.bodies.push_back({body.name, body.particle_count, static_cast<Index>(its_ends.size() / 2),
                             its_ends.empty() ? 0 : fingerprint_of_springs(its_ends)});
  }
  return former;
}

/// The last of the checkpoint and the record of a run's folder. OBJ files alone know no springs.
FormerRun read_former_run(const fs::path& folder, bool& knows_springs) {
  constexpr const char* kRemedy = "run its scene again, or remove \"initial_state\"";
  knows_springs = true;
  if (!fs::is_directory(folder)) return former_run(read_checkpoint(folder, kRemedy));
  const auto run = written_run(folder / kRunSummaryFile);
  if (fs::exists(folder / kCheckpointFile)) {
    Checkpoint checkpoint = read_checkpoint(folder / kCheckpointFile, kRemedy);
    const std::int64_t frames = 1 + checkpoint.state.frame;
    if (!run || frames >= run->frames_written) return former_run(std::move(checkpoint));
  }
  const RecordedRun record(folder);
  knows_springs = record.is_complete();
  return former_run(record);
}

/// Beside the scene, or where the program was started.
std::optional<fs::path> find(const Scene& scene, std::vector<Problem>& problems) {
  const std::vector<fs::path> candidates{scene.file.parent_path() / scene.initial_state, fs::path(scene.initial_state)};
  std::error_code ignored;
  for (const fs::path& candidate : candidates) {
    if (fs::exists(candidate, ignored)) return candidate;
  }
  std::vector<std::string> looked{candidates.front().string()};
  if (candidates.back() != candidates.front()) looked.push_back(candidates.back().string());
  problems.push_back({scene.file.string(), "initial_state", "\"" + scene.initial_state + "\"",
                      "no such folder: looked for " + joined(looked),
                      "give the folder of a run, from where the scene is or from where you are"});
  return std::nullopt;
}

void warn_of_ignored_places(const Scene& scene, BuiltScene& built) {
  std::vector<std::string> names;
  for (const BodyScene& body : scene.bodies) {
    const bool is_placed = !body.place.position.isZero(0.0) || !body.place.rotation.isZero(0.0);
    if (is_placed || !body.velocity.isZero(0.0)) names.push_back(body.name);
  }
  if (names.empty()) return;
  built.warnings.push_back("The position and rotation in \"place\", and \"velocity\", of " + names_text("body", "bodies", names) +
                           " are ignored, as \"initial_state\" gives positions and velocities.");
}

/// Copies what belongs to each body from the order of the former run to that of the network.
class Mapping {
 public:
  Mapping(const FormerRun& former, const SpringNetwork& network) : former_(former), network_(network) {}

  template <class Copy>
  void for_particles(const Copy& copy) const {
    for_bodies([&](const Body& body, Index first_particle, Index /*first_spring*/) {
      copy(first_particle, body.first_particle, body.particle_count);
    });
  }
  /// Entries of springs.
  template <class Entry>
  [[nodiscard]] std::vector<Entry> of_springs(const std::vector<Entry>& list) const {
    std::vector<Entry> mapped(static_cast<std::size_t>(network_.springs.count()));
    for_bodies([&](const Body& body, Index /*first_particle*/, Index first_spring) {
      std::copy_n(list.begin() + first_spring, body.spring_count, mapped.begin() + body.first_spring);
    });
    return mapped;
  }
  [[nodiscard]] Points of_particles(const Points& points) const {
    Points mapped(3, network_.particle_count());
    for_particles([&](Index from, Index to, Index count) { mapped.middleCols(to, count) = points.middleCols(from, count); });
    return mapped;
  }

 private:
  template <class Visit>
  void for_bodies(const Visit& visit) const {
    for (const Body& body : network_.bodies) {
      Index particle = 0;
      Index spring = 0;
      for (const NamedCount& before : former_.bodies) {
        if (before.name == body.name) break;
        particle += before.particles;
        spring += before.springs;
      }
      visit(body, particle, spring);
    }
  }

  const FormerRun& former_;
  const SpringNetwork& network_;
};

Slip mapped_slip(const FormerRun& former, const Mapping& mapping, const BuiltScene& built) {
  std::vector<Index> number_of;  // of the former obstacles, in this scene
  for (const NamedCount& obstacle : former.obstacles) {
    const auto found = std::ranges::find(built.obstacles, obstacle.name, &Obstacle::name);
    number_of.push_back(found == built.obstacles.end() ? kNone : static_cast<Index>(found - built.obstacles.begin()));
  }
  Slip slip;
  slip.displacement = mapping.of_particles(former.slip.displacement);
  slip.obstacle.assign(static_cast<std::size_t>(built.network.particle_count()), kNone);
  mapping.for_particles([&](Index from, Index to, Index count) {
    for (Index k = 0; k < count; ++k) {
      const Index before = former.slip.obstacle[static_cast<std::size_t>(from + k)];
      if (before != kNone) slip.obstacle[static_cast<std::size_t>(to + k)] = number_of[static_cast<std::size_t>(before)];
      if (slip.obstacle[static_cast<std::size_t>(to + k)] == kNone) slip.displacement.col(to + k).setZero();
    }
  });
  return slip;
}

/// Springs that broke can stay so only in a body whose springs may break.
void check_broken(const Scene& scene, const BuiltScene& built, std::vector<Problem>& problems) {
  for (const Body& body : built.network.bodies) {
    Index count = 0;
    bool may_break = false;
    for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
      if (built.start.broken[static_cast<std::size_t>(s)] != 0) ++count;
      may_break = may_break || built.network.springs.law(s).breaks();
    }
    if (count == 0 || may_break) continue;
    problems.push_back({scene.file.string(), "bodies." + body.name + ".springs", "",
                        counted(static_cast<std::size_t>(count), "spring") + " that broke in \"initial_state\" may not break here",
                        "give the body the \"break\" that it had there"});
  }
}

/// Springs that yielded keep their rest lengths only in a body whose springs may yield.
void check_yielded(const Scene& scene, const FormerRun& former, const Mapping& mapping, const BuiltScene& built,
                   std::vector<Problem>& problems) {
  const std::vector<double> lengths = mapping.of_springs(former.rest_lengths);
  const Springs& springs = built.network.springs;
  for (const Body& body : built.network.bodies) {
    std::size_t count = 0;
    for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
      const auto spring = static_cast<std::size_t>(s);
      if (lengths[spring] != springs.rest_length[spring] && !springs.law(s).yields()) ++count;
    }
    if (count == 0) continue;
    problems.push_back({scene.file.string(), "bodies." + body.name + ".springs", "",
                        counted(count, "spring") + " had other rest lengths in \"initial_state\" and may not yield here",
                        "give the body the shape and the \"yield\" that it had there"});
  }
}

}  // namespace

void begin_as_run_ended(const Scene& scene, BuiltScene& built, std::vector<Problem>& problems) {
  const auto folder = find(scene, problems);
  if (!folder) return;
  built.initial_state = *folder;
  bool knows_springs = false;
  FormerRun former = read_former_run(*folder, knows_springs);
  std::vector<NamedCount> bodies = bodies_of(built.network);
  if (!knows_springs) {
    for (NamedCount& body : bodies) body = {.name = body.name, .particles = body.particles};
  }
  for (const std::string& difference : differences(bodies, former.bodies)) {
    problems.push_back({scene.file.string(), "initial_state", "\"" + scene.initial_state + "\"", "in this run " + difference,
                        "give the run of a scene with the same bodies"});
  }
  if (!problems.empty()) return;
  const Mapping mapping(former, built.network);
  const bool has_velocities = former.velocities.cols() == former.positions.cols();
  built.start.positions = mapping.of_particles(former.positions);
  built.start.velocities = has_velocities ? mapping.of_particles(former.velocities) : Points::Zero(3, former.positions.cols());
  if (!has_velocities) {
    built.warnings.push_back("\"initial_state\" begins with velocities of 0, as " + folder->string() +
                             " has neither record.bin nor checkpoint.bin.");
  }
  const SpringState start = initial_springs(built.network.springs);
  if (!former.rest_lengths.empty()) {
    check_yielded(scene, former, mapping, built, problems);
    if (!start.rest_lengths.empty()) built.start.rest_lengths = mapping.of_springs(former.rest_lengths);
  } else if (!start.rest_lengths.empty()) {
    built.warnings.push_back("\"initial_state\" begins with the rest lengths of the shape, as the last frame of " +
                             folder->string() + " has no checkpoint. Resume that run to its end, if its springs yielded.");
  }
  if (std::ranges::count(former.broken, 1) > 0) {
    built.start.broken = mapping.of_springs(former.broken);
    check_broken(scene, built, problems);
  }
  if (former.slip.displacement.cols() == former.positions.cols()) built.start.slip = mapped_slip(former, mapping, built);
  warn_of_ignored_places(scene, built);
}

}  // namespace sprung
