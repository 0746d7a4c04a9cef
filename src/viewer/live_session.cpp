#include "viewer/live_session.h"

#include "base/error.h"
#include "geometry/mesh/polygon_mesh.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>

namespace sprung {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxCommands = 10000;  // a page that sends more than the simulation takes loses its last ones

double seconds_between(Clock::time_point from, Clock::time_point to) { return std::chrono::duration<double>(to - from).count(); }

Vector3 vector_of(const Json& json) { return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()}; }

}  // namespace

/// A run and what it showed last.
struct LiveSession::Shown {
  explicit Shown(std::uint32_t run_number, SceneSource source) : number(run_number), run(std::move(source)) {}

  std::uint32_t number;
  LiveRun run;
  std::uint32_t generation = 0;
  bool told_divergence = false;
  double frame_ms = 0.0;
  // The factor to real time is measured since then.
  Clock::time_point measured_from{};
  double measured_time = 0.0;  ///< [s]
  double realtime = 0.0;
};

LiveSession::LiveSession(SceneSource source, std::vector<ExampleScene> examples)
    : first_source_(std::move(source)), examples_(std::move(examples)) {}

LiveSession::~LiveSession() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::string LiveSession::hello() const {
  std::vector<std::string> names;
  for (const ExampleScene& example : examples_) names.push_back(example.name);
  return hello_text("live", std::filesystem::path(first_source_.file).filename().string(), names);
}

void LiveSession::start(Publisher& publisher) {
  publisher_ = &publisher;
  thread_ = std::thread([this] { simulate(); });
}

void LiveSession::handle(ClientId client, std::string text) {
  {
    const std::lock_guard lock(mutex_);
    if (commands_.size() < kMaxCommands) commands_.emplace_back(client, std::move(text));
  }
  changed_.notify_all();
}

void LiveSession::set_watchers(int count) {
  {
    const std::lock_guard lock(mutex_);
    watchers_ = count;
  }
  changed_.notify_all();
}

void LiveSession::simulate() {
  open(first_source_, "");
  publish_state();
  std::vector<std::pair<ClientId, std::string>> commands;
  while (true) {
    take_commands(commands);
    {
      const std::lock_guard lock(mutex_);
      if (ending_) return;
    }
    for (const auto& [client, text] : commands) obey(client, text);
    if (!commands.empty()) continue;
    const auto now = Clock::now();
    if (play_.speed > 0.0 && now < due_) continue;
    try {
      advance(steps_of_frame());
    } catch (const StoppedError&) {
      return;
    }
    const double simulated = runs_.front()->run.simulator().settings().step * steps_of_frame();
    const auto frame = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(play_.speed > 0.0 ? simulated / play_.speed : 0.0));
    due_ = std::max(due_ + frame, now);  // a simulation that is late does not hurry afterwards
  }
}

/// Waits until there are commands, or the next frame is due.
void LiveSession::take_commands(std::vector<std::pair<ClientId, std::string>>& commands) {
  commands.clear();
  std::unique_lock lock(mutex_);
  const auto called = [&] { return ending_ || !commands_.empty(); };
  const auto runs = [&] { return play_.playing && watchers_ > 0 && !runs_.empty() && !all_diverged(); };
  if (!called() && !runs()) changed_.wait(lock, [&] { return called() || runs(); });
  if (!called() && play_.speed > 0.0) changed_.wait_until(lock, due_, called);
  commands.assign(commands_.begin(), commands_.end());
  commands_.clear();
}

void LiveSession::obey(ClientId client, const std::string& text) try {
  const Json message = Json::parse(text);
  const auto what = message.at("do").get<std::string>();
  const auto shown = [&]() -> Shown& { return *runs_.at(message.value("run", std::size_t{0})); };
  if (what == "play" || what == "pause") {
    play_.playing = what == "play";
    due_ = Clock::now();
    for (auto& run : runs_) run->measured_from = {};
    publish_state();
  } else if (what == "step" || what == "frame") {
    play_.playing = false;
    publish_state();
    advance(what == "step" ? 1 : steps_of_frame());
  } else if (what == "reset") {
    for (auto& run : runs_) run->run.reset();
    for (const auto& run : runs_) begin_run(run->number, false);
  } else if (what == "every") {
    play_.every = std::clamp(message.at("steps").get<int>(), 0, 1000000);
    publish_state();
  } else if (what == "speed") {
    play_.speed = std::clamp(message.at("factor").get<double>(), 0.0, 1000.0);
    due_ = Clock::now();
    publish_state();
  } else if (what == "set") {
    const std::optional<std::uint32_t> run =
        message.contains("run") ? std::optional(message.at("run").get<std::uint32_t>()) : std::nullopt;
    change(run, message.at("key").get<std::string>(), message.at("value").dump());
  } else if (what == "compare") {
    compare(message.at("integrator").get<std::string>());
  } else if (what == "single") {
    while (runs_.size() > 1) {
      publisher_->remove_run(runs_.back()->number);
      runs_.pop_back();
    }
  } else if (what == "open") {
    const auto name = message.at("example").get<std::string>();
    const auto found = std::ranges::find(examples_, name, &ExampleScene::name);
    if (found == examples_.end()) return publisher_->tell(client, error_text("there is no example " + name));
    open({.file = found->file, .overrides = {}, .mesh_paths = first_source_.mesh_paths}, "");
  } else if (what == "grab") {
    shown().run.grab(message.at("particle").get<Index>());
  } else if (what == "drag") {
    for (auto& run : runs_) run->run.drag(vector_of(message.at("target")));
  } else if (what == "drop") {
    for (auto& run : runs_) {
      run->run.drop(message.value("pin", false));
      publish_frame(*run);
    }
  } else if (what == "release") {
    shown().run.release(message.at("particle").get<Index>());
    publish_frame(shown());
  } else if (what == "obj") {
    const Simulator& simulator = shown().run.simulator();
    const auto name = message.at("body").get<std::string>();
    for (const Body& body : simulator.network().bodies) {
      if (body.name != name) continue;
      const Points vertices = simulator.positions().middleCols(body.first_particle, body.particle_count);
      publisher_->tell(client, obj_message(name + ".obj", obj_text(vertices, body.surface.faces, body.surface.segments)));
    }
  } else {
    publisher_->tell(client, error_text("there is no command " + what));
  }
} catch (const Json::exception& error) {
  publisher_->tell(client, error_text(std::string("the message was not understood: ") + error.what()));
} catch (const std::out_of_range&) {
  publisher_->tell(client, error_text("there is no such run"));
} catch (const StoppedError&) {
  return;
}

/// A scene with mistakes leaves what is there.
void LiveSession::open(const SceneSource& source, const std::string& key) {
  try {
    auto opened = std::make_unique<Shown>(0, source);
    while (runs_.size() > 1) {
      publisher_->remove_run(runs_.back()->number);
      runs_.pop_back();
    }
    runs_.clear();
    runs_.push_back(std::move(opened));
    publisher_->show_failure("");
    begin_run(0, false);
  } catch (const InputError& error) {
    const std::string text = problems_text(std::nullopt, key, error.problems());
    if (runs_.empty()) {
      publisher_->show_failure(text);
    } else {
      publisher_->tell_all(text);
    }
  } catch (const FileError& error) {
    const std::string text = problems_text(std::nullopt, key, {{source.file, "", "", error.what(), ""}});
    if (runs_.empty()) {
      publisher_->show_failure(text);
    } else {
      publisher_->tell_all(text);
    }
  }
}

void LiveSession::compare(const std::string& integrator) try {
  if (runs_.empty()) return;
  SceneSource source = runs_.front()->run.source();
  source.overrides.push_back("integrator={\"type\":" + Json(integrator).dump() + "}");
  auto second = std::make_unique<Shown>(1, std::move(source));
  if (runs_.size() > 1) runs_.pop_back();
  runs_.push_back(std::move(second));
  runs_.front()->run.reset();
  begin_run(0, false);
  begin_run(1, false);
} catch (const InputError& error) {
  publisher_->tell_all(problems_text(1, "integrator", error.problems()));
}

void LiveSession::change(std::optional<std::uint32_t> run, const std::string& key, const std::string& value) {
  for (const auto& shown : runs_) {
    if (run && *run != shown->number) continue;
    try {
      begin_run(shown->number, shown->run.change({key + "=" + value}));
    } catch (const InputError& error) {
      publisher_->tell_all(problems_text(shown->number, key, error.problems()));
    }
  }
}

/// Shows a run anew; `live` says whether its state goes on.
void LiveSession::begin_run(std::uint32_t number, bool live) {
  Shown& shown = *runs_.at(number);
  shown.generation = next_generation_++;
  shown.told_divergence = false;
  shown.measured_from = {};
  due_ = Clock::now();
  shown.run.stop_when([this] {
    const std::lock_guard lock(mutex_);
    return ending_;
  });
  const MessageHeader header{
      .run = number, .generation = shown.generation, .frame = shown.run.frame(), .time = shown.run.simulator().time()};
  publisher_->show_scene(number, scene_text(number, shown.generation, live, shown.run),
                         std::make_shared<const Bytes>(topology_message(header, shown.run.topology())));
  publish_frame(shown);
}

void LiveSession::advance(int steps) {
  for (auto& shown : runs_) {
    const auto begin = Clock::now();
    if (shown->measured_from == Clock::time_point{}) {
      shown->measured_from = begin;
      shown->measured_time = shown->run.simulator().time();
    }
    for (int k = 0; k < steps; ++k) shown->run.step();
    const auto end = Clock::now();
    shown->frame_ms = 1e3 * seconds_between(begin, end);
    publish_frame(*shown);
  }
}

void LiveSession::publish_frame(Shown& shown) {
  const auto now = Clock::now();
  const double elapsed = seconds_between(shown.measured_from, now);
  if (shown.measured_from != Clock::time_point{} && elapsed > 0.5) {
    shown.realtime = (shown.run.simulator().time() - shown.measured_time) / elapsed;
    shown.measured_from = now;
    shown.measured_time = shown.run.simulator().time();
  }
  if (shown.run.failure()) {
    if (!shown.told_divergence) publisher_->show_divergence(shown.number, diverged_text(shown.number, shown.generation, shown.run));
    shown.told_divergence = true;
    return;  // the state is not finite
  }
  FrameNumbers numbers = shown.run.numbers();
  numbers.frame_ms = shown.frame_ms;
  numbers.realtime = shown.realtime;
  const MessageHeader header{.run = shown.number,
                             .generation = shown.generation,
                             .frame = shown.run.frame(),
                             .time = shown.run.simulator().time(),
                             .playing = play_.playing};
  publisher_->show_frame(shown.number, std::make_shared<const Bytes>(frame_message(header, numbers, shown.run.state())));
}

void LiveSession::publish_state() { publisher_->show_state(state_text(play_)); }

int LiveSession::steps_of_frame() const {
  if (play_.every > 0) return play_.every;
  return runs_.empty() ? 1 : runs_.front()->run.loaded().steps_per_frame;
}

bool LiveSession::all_diverged() const {
  return std::ranges::all_of(runs_, [](const auto& shown) { return shown->run.failure().has_value(); });
}

}  // namespace sprung
