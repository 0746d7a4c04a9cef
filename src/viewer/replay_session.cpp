#include "viewer/replay_session.h"

#include "base/error.h"
#include "network/model/pin_schedule.h"
#include "output/run_record.h"
#include "viewer/live_run.h"
#include "viewer/page_command.h"
#include "viewer/text_messages.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sprung {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kGeneration = 1;

/// The particle of each vertex of a body's frames, counted within the body.
std::vector<Index> particles_of(const LoadedScene& scene, const Body& body) {
  const auto source = scene.sources.find(body.name);
  if (source != scene.sources.end() && !source->second->particle_of.empty()) return source->second->particle_of;
  std::vector<Index> particles(static_cast<std::size_t>(body.vertex_count()));
  std::iota(particles.begin(), particles.end(), 0);
  return particles;
}

std::vector<Index> particles_of_frames(const LiveRun* live) {
  std::vector<Index> particles;
  if (live == nullptr) return particles;
  for (const Body& body : live->simulator().network().bodies) {
    for (const Index particle : particles_of(live->loaded(), body)) particles.push_back(body.first_particle + particle);
  }
  return particles;
}

/// The simulator of the run's scene, if it has the run's particles.
std::unique_ptr<const LiveRun> scene_of(const RecordedRun& run, const std::vector<std::string>& mesh_paths) try {
  if (run.scene().empty()) return nullptr;
  auto live = std::make_unique<const LiveRun>(SceneSource{
      .file = (run.folder() / kRunRecordFile).string(), .overrides = {}, .mesh_paths = mesh_paths, .text = run.scene()});
  const std::vector<Body>& bodies = live->simulator().network().bodies;
  const bool same = std::ranges::equal(bodies, run.bodies(), [&](const Body& body, const RecordedMesh& mesh) {
    return body.name == mesh.name && std::ssize(particles_of(live->loaded(), body)) == mesh.first.vertices.cols();
  });
  return same ? std::move(live) : nullptr;
} catch (const std::runtime_error&) {
  return nullptr;  // its meshes may be gone, or it is of an older version
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
  for (const RecordedMesh& body : run.bodies()) {
    const std::vector<Index>& corner_begin = body.first.faces.corner_begin;
    const auto triangles_before = [&](Index face) { return corner_begin[face] - 2 * face; };
    for (const TornFaces& torn : run.torn_faces()) {
      if (torn.body != body.name) continue;
      Json triangles = Json::array();
      for (const Index face : torn.faces) {
        for (Index t = triangles_before(face); t < triangles_before(face + 1); ++t) triangles.push_back(first + t);
      }
      all.push_back({{"frame", torn.frame}, {"triangles", triangles}});
    }
    first += triangles_before(body.first.faces.face_count());
  }
  return all;
}

}  // namespace

Replay::Replay(const std::filesystem::path& folder, const std::vector<std::string>& mesh_paths)
    : run_(folder), live_(scene_of(run_, mesh_paths)), particle_of_(particles_of_frames(live_.get())) {}
Replay::~Replay() = default;

std::string Replay::scene_text() const {
  const Json scene = run_.scene().empty() ? Json::object() : Json::parse(run_.scene());
  Json bodies = Json::array();
  Eigen::Index first = 0;
  for (const RecordedMesh& body : run_.bodies()) {
    bodies.push_back({{"name", body.name}, {"first", first}, {"count", body.first.vertices.cols()}});
    first += body.first.vertices.cols();
  }
  Json obstacles = Json::array();
  for (const RecordedMesh& obstacle : run_.obstacles()) {
    obstacles.push_back({{"name", obstacle.name}, {"motion", obstacle.changes() ? "deforming" : "fixed"}});
  }
  const Json integrator = scene.contains("integrator") ? scene["integrator"] : Json();
  const Json message{{"type", "scene"},
                     {"run", 0},
                     {"generation", kGeneration},
                     {"title", run_.folder().string()},
                     {"integrator", integrator.is_object() ? integrator.value("type", Json("verlet")) : Json("verlet")},
                     {"step", run_.step()},
                     {"steps_per_frame", run_.steps_per_frame()},
                     {"frame_rate", run_.frame_rate()},
                     {"frames", run_.frames()},
                     {"largest_stable_step", Json()},
                     {"live", false},
                     {"complete", live_ != nullptr},
                     {"scene", scene},
                     {"changed", scene},
                     {"warnings", run_.warnings()},
                     {"bodies", bodies},
                     {"obstacles", obstacles},
                     {"torn", torn_triangles(run_)},
                     {"diagnostics", table_of(run_.diagnostics())}};
  return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Topology Replay::topology() const {
  Topology topology;
  if (live_) topology = live_->topology();
  topology.triangles.resize(3, 0);
  topology.segments.resize(2, 0);
  topology.obstacles.clear();
  Index first = 0;
  for (const RecordedMesh& body : run_.bodies()) {
    append_columns(triangulate(body.first.faces), first, topology.triangles);
    append_columns(body.first.lines, first, topology.segments);
    first += static_cast<Index>(body.first.vertices.cols());
  }
  topology.particles = first;
  if (live_) show_springs_of_vertices(topology);
  for (const RecordedMesh& obstacle : run_.obstacles()) {
    TriangleMesh mesh;
    mesh.vertices = obstacle.first.vertices;
    mesh.triangles = triangulate(obstacle.first.faces);
    topology.obstacles.push_back(std::move(mesh));
  }
  return topology;
}

/// Leaves out springs of particles that frames lack, such as those of cells that carry a surface.
void Replay::show_springs_of_vertices(Topology& topology) const {
  std::vector<Index> vertex_of(live_->simulator().network().particle_count(), kNone);  // one of those of a particle
  for (std::size_t i = 0; i < particle_of_.size(); ++i) vertex_of[particle_of_[i]] = static_cast<Index>(i);
  Index kept = 0;
  for (Index s = 0; s < topology.springs.cols(); ++s) {
    const Index first = vertex_of[topology.springs(0, s)];
    const Index second = vertex_of[topology.springs(1, s)];
    if (first == kNone || second == kNone) continue;
    topology.springs.col(kept) << first, second;
    topology.rest_lengths[kept] = topology.rest_lengths[s];
    topology.kinds[kept++] = topology.kinds[s];
  }
  topology.springs.conservativeResize(2, kept);
  topology.rest_lengths.resize(kept);
  topology.kinds.resize(kept);
}

/// Whether pins hold each particle of the network in a frame.
std::vector<char> Replay::pinned(int frame) const {
  const SpringNetwork& network = live_->simulator().network();
  std::vector<char> pinned(network.particle_count(), 0);
  const double time = due_before(static_cast<std::int64_t>(frame - 1) * run_.steps_per_frame(), run_.step());
  for (const std::vector<Pin>* pins : {&network.pins, &network.later_pins}) {
    for (const Pin& pin : *pins) {
      if (!holds_at(pin, time)) continue;
      for (const Index particle : pin.particles) pinned[particle] = 1;
    }
  }
  return pinned;
}

FrameState Replay::state(int frame) const {
  FrameState state;
  for (const RecordedMesh& body : run_.bodies()) {
    const Points positions = run_.positions(body, frame);
    const Eigen::Index first = state.positions.cols();
    state.positions.conservativeResize(3, first + positions.cols());
    state.positions.rightCols(positions.cols()) = positions;
  }
  for (const RecordedMesh& obstacle : run_.obstacles()) {
    if (obstacle.changes()) state.deformed.push_back(run_.positions(obstacle, frame));
  }
  state.states.assign(static_cast<std::size_t>(state.positions.cols()), 0);
  const std::vector<char> is_pinned = live_ ? pinned(frame) : std::vector<char>();
  for (std::size_t i = 0; live_ && i < state.states.size(); ++i) {
    if (is_pinned[particle_of_[i]] != 0) state.states[i] = kPinned;
  }
  state.speeds = Scalars::Zero(state.positions.cols());
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

ReplaySession::ReplaySession(const std::filesystem::path& folder, const std::vector<std::string>& mesh_paths)
    : replay_(folder, mesh_paths) {}

ReplaySession::~ReplaySession() { stop(); }

void ReplaySession::stop() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::string ReplaySession::hello() const { return hello_text("replay", replay_.run().folder().string(), {}); }

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
