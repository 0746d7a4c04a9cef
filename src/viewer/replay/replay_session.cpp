#include "viewer/replay/replay_session.h"

#include "base/error.h"
#include "viewer/protocol/page_command.h"
#include "viewer/protocol/text_messages.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprung {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kGeneration = 1;

std::vector<Index> particles_of_vertices(const RecordedModel& model) {
  std::vector<Index> particles;
  for (const RecordedBody& body : model.bodies) particles.insert(particles.end(), body.particle_of.begin(), body.particle_of.end());
  return particles;
}

double column(const RecordedDiagnostics& table, const std::string& name, std::size_t row) {
  const auto found = std::ranges::find(table.columns, name);
  if (found == table.columns.end() || row >= table.rows.size()) return 0.0;
  const double value = table.rows[row][static_cast<std::size_t>(found - table.columns.begin())];
  return std::isfinite(value) ? value : 0.0;
}

Json table_of(const RecordedDiagnostics& diagnostics) {
  Json rows = Json::array();
  for (const std::vector<double>& row : diagnostics.rows) {
    Json numbers = Json::array();
    for (const double value : row) numbers.push_back(std::isfinite(value) ? Json(value) : Json());
    rows.push_back(numbers);
  }
  return {{"columns", diagnostics.columns}, {"rows", rows}};
}

/// The triangles of the topology that are gone from a frame on.
Json torn_triangles(const RecordedRun& run) {
  Json all = Json::array();
  Index first = 0;  // triangle of the body
  for (const RecordedBody& body : run.model().bodies) {
    const std::vector<Index>& corner_begin = body.faces.corner_begin;
    const auto triangles_before = [&](Index face) { return corner_begin[face] - 2 * face; };
    for (const TornFaces& torn : run.torn_faces()) {
      if (torn.body != body.name) continue;
      Json triangles = Json::array();
      for (const Index face : torn.faces) {
        for (Index t = triangles_before(face); t < triangles_before(face + 1); ++t) triangles.push_back(first + t);
      }
      all.push_back({{"frame", torn.frame}, {"triangles", triangles}});
    }
    first += triangles_before(body.faces.face_count());
  }
  return all;
}

/// The springs of the topology that are gone from a frame on.
Json broken_springs(const RecordedRun& run, const std::vector<Index>& spring_of) {
  Json all = Json::array();
  for (const BrokenSprings& broken : run.broken_springs()) {
    Json springs = Json::array();
    for (const Index spring : broken.springs) {
      const auto shown = std::ranges::lower_bound(spring_of, spring);
      if (shown != spring_of.end() && *shown == spring) springs.push_back(shown - spring_of.begin());
    }
    all.push_back({{"frame", broken.frame}, {"springs", springs}});
  }
  return all;
}

}  // namespace

/// Frames lack particles such as those of cells that carry a surface.
Replay::Replay(const std::filesystem::path& folder) : run_(folder), particle_of_(particles_of_vertices(run_.model())) {
  std::vector<Index> vertex_of(static_cast<std::size_t>(run_.model().particle_count), kNone);  // one of those of a particle
  for (std::size_t i = 0; i < particle_of_.size(); ++i) vertex_of[particle_of_[i]] = static_cast<Index>(i);
  const Edges& ends = run_.model().springs.ends;
  springs_.resize(Eigen::NoChange, ends.cols());
  for (Index s = 0; s < ends.cols(); ++s) {
    const Index first = vertex_of[ends(0, s)];
    const Index second = vertex_of[ends(1, s)];
    if (first == kNone || second == kNone) continue;
    springs_.col(std::ssize(spring_of_)) << first, second;
    spring_of_.push_back(s);
  }
  springs_.conservativeResize(Eigen::NoChange, std::ssize(spring_of_));
}

std::string Replay::scene_text() const {
  const Json scene = run_.scene().empty() ? Json::object() : Json::parse(run_.scene());
  Json bodies = Json::array();
  std::size_t first = 0;
  for (const RecordedBody& body : run_.model().bodies) {
    bodies.push_back({{"name", body.name}, {"first", first}, {"count", body.particle_of.size()}});
    first += body.particle_of.size();
  }
  Json obstacles = Json::array();
  for (const RecordedObstacle& obstacle : run_.model().obstacles) {
    obstacles.push_back({{"name", obstacle.name}, {"motion", kObstacleMotionNames[static_cast<std::size_t>(obstacle.motion)]}});
  }
  std::vector<std::string> warnings = run_.warnings();
  if (!run_.missing().empty()) warnings.push_back(run_.missing());
  const Json integrator = scene.contains("integrator") ? scene["integrator"] : Json();
  const Json message{{"type", "scene"},
                     {"run", 0},
                     {"generation", kGeneration},
                     {"title", run_.title()},
                     {"integrator", integrator.is_object() ? integrator.value("type", Json("verlet")) : Json("verlet")},
                     {"step", run_.step()},
                     {"steps_per_frame", run_.steps_per_frame()},
                     {"frame_rate", run_.frame_rate()},
                     {"frames", run_.frames()},
                     {"largest_stable_step", Json()},
                     {"live", false},
                     {"complete", run_.is_complete()},
                     {"scene", scene},
                     {"changed", scene},
                     {"warnings", warnings},
                     {"bodies", bodies},
                     {"obstacles", obstacles},
                     {"torn", torn_triangles(run_)},
                     {"broken", broken_springs(run_, spring_of_)},
                     {"diagnostics", table_of(run_.diagnostics())}};
  return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Topology Replay::topology() const {
  const RecordedModel& model = run_.model();
  Topology topology;
  Index first = 0;
  for (const RecordedBody& body : model.bodies) {
    append_columns(triangulate(body.faces), first, topology.triangles);
    append_columns(body.lines, first, topology.segments);
    first += static_cast<Index>(body.particle_of.size());
  }
  topology.particles = first;
  topology.springs = springs_;
  for (const Index s : spring_of_) {
    topology.rest_lengths.push_back(static_cast<float>(model.springs.rest_lengths[s]));
    topology.kinds.push_back(static_cast<std::uint32_t>(model.springs.kinds[s]));
  }
  for (const RecordedObstacle& obstacle : model.obstacles) topology.obstacles.push_back(obstacle.mesh);
  return topology;
}

FrameState Replay::state(int frame) const {
  const RecordedFrame recorded = run_.frame(frame);
  const std::vector<RecordedObstacle>& obstacles = run_.model().obstacles;
  FrameState state;
  state.positions = recorded.positions(Eigen::all, particle_of_);
  state.speeds = Scalars::Zero(state.positions.cols());
  if (recorded.velocities.cols() > 0) {
    state.speeds = recorded.velocities.colwise().norm().transpose()(particle_of_);
  }
  for (const Index particle : particle_of_) state.states.push_back(recorded.states[particle]);
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    if (obstacles[k].motion == ObstacleMotion::rigid) state.poses.push_back(recorded.poses[k]);
    if (obstacles[k].motion != ObstacleMotion::deforming) continue;
    state.deformed.push_back(recorded.poses[k] * recorded.deformed[state.deformed.size()]);
  }
  return state;
}

FrameNumbers Replay::numbers(int frame) const {
  const auto value = [&](const char* name) { return column(run_.diagnostics(), name, static_cast<std::size_t>(frame - 1)); };
  const auto count = [&](const char* name) {
    return static_cast<Index>(std::clamp(value(name), 0.0, static_cast<double>(std::numeric_limits<Index>::max())));
  };
  return {.kinetic = value("kinetic_energy"),
          .elastic = value("elastic_energy"),
          .gravity = value("gravity_energy"),
          .max_stretch = value("max_stretch"),
          .contacts = count("contacts"),
          .frame_ms = value("frame_ms"),
          .infeasible = count("infeasible"),
          .contact_energy = value("contact_energy")};
}

ReplaySession::ReplaySession(const std::filesystem::path& folder) : replay_(folder) {}

ReplaySession::~ReplaySession() { stop(); }

void ReplaySession::stop() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::string ReplaySession::hello() const { return hello_text("replay", replay_.run().title(), {}); }

void ReplaySession::start(Publisher& publisher) {
  publisher_ = &publisher;
  const MessageHeader header{.run = 0, .generation = kGeneration};
  publisher.show_scene(0, replay_.scene_text(), std::make_shared<const Bytes>(topology_message(header, replay_.topology())));
  publisher.show_frame(0, frame(1));
  thread_ = std::thread([this] { answer_all(); });
}

void ReplaySession::handle(ClientId client, std::string text) {
  {
    const std::lock_guard lock(mutex_);
    if (messages_.size() < kMaxMessages) messages_.emplace_back(client, std::move(text));
  }
  changed_.notify_all();
}

void ReplaySession::answer_all() {
  while (true) {
    std::pair<ClientId, std::string> message;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return ending_ || !messages_.empty(); });
      if (ending_) return;
      message = std::move(messages_.front());
      messages_.pop_front();
    }
    answer(message.first, message.second);
  }
}

void ReplaySession::answer(ClientId client, const std::string& text) try {
  const PageCommand command(text);
  if (command.name() != "seek") throw PageCommandError("a replay has no command " + command.name());
  publisher_->send(client, frame(static_cast<int>(command.integer("frame", 1, replay_.run().frames()))));
} catch (const std::exception& error) {
  publisher_->tell(client, error_text(error.what()));
}

SharedBytes ReplaySession::frame(int number) const {
  const MessageHeader header{
      .run = 0, .generation = kGeneration, .frame = static_cast<std::uint32_t>(number), .time = replay_.time(number)};
  return std::make_shared<const Bytes>(frame_message(header, replay_.numbers(number), replay_.state(number)));
}

}  // namespace sprung
