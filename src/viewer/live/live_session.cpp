#include "viewer/live/live_session.h"

#include "base/error.h"
#include "base/format.h"
#include "output/exporters/exporter.h"
#include "output/run_recorder.h"
#include "scene/reading/scene_reader.h"
#include "simulation/tension.h"
#include "viewer/live/saving.h"
#include "viewer/live/shown_simulator.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

namespace sprung {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr int kMostStepsShownAtOnce = 1'000'000;

// Factors to real time.
constexpr double kLeastSpeed = 1e-3;
constexpr double kGreatestSpeed = 1e3;

constexpr auto kLookInterval = std::chrono::milliseconds(300);

double seconds_between(Clock::time_point from, Clock::time_point to) { return std::chrono::duration<double>(to - from).count(); }

}  // namespace

/// A run and what it showed last.
struct LiveSession::Shown {
  explicit Shown(std::uint32_t run_number, SceneSource source) : number(run_number), run(std::move(source)) {}

  std::uint32_t number;
  LiveRun run;
  std::uint32_t generation = 0;
  bool told_divergence = false;
  Index broken_springs = 0;  ///< in the topology that the pages have
  double frame_ms = 0.0;
  // The factor to real time is measured since then.
  Clock::time_point measured_from{};
  double measured_time = 0.0;  ///< [s]
  double realtime = 0.0;
};

LiveSession::LiveSession(SceneSource source, std::vector<ExampleScene> examples, TellProblems tell_problems,
                         std::filesystem::path save_to)
    : first_source_(std::move(source)),
      examples_(std::move(examples)),
      tell_problems_(std::move(tell_problems)),
      save_to_(std::move(save_to)) {
  if (!first_source_.text) check_scene_file(first_source_.file);
}

LiveSession::~LiveSession() { stop(); }

std::string LiveSession::hello() const {
  return hello_text("live", std::filesystem::path(first_source_.file).filename().string(), examples_);
}

void LiveSession::start(Publisher& publisher) {
  publisher_ = &publisher;
  thread_ = std::thread([this] { simulate(); });
}

void LiveSession::stop() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void LiveSession::handle(ClientId client, std::string text) {
  {
    const std::lock_guard lock(mutex_);
    if (messages_.size() < kMaxMessages) messages_.push_back({.client = client, .text = std::move(text)});
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

void LiveSession::leave(ClientId client) {
  {
    const std::lock_guard lock(mutex_);
    messages_.push_back({.client = client, .text = "", .is_last = true});
  }
  changed_.notify_all();
}

void LiveSession::simulate() {
  open(first_source_);
  tell_problems_ = {};
  publish_state();
  std::vector<Message> messages;
  while (true) {
    const bool is_due = take_messages(messages);
    if (is_ending()) return;
    for (const Message& message : messages) {
      obey(message);
      if (is_ending()) return;
    }
    look_at_file();
    if (!is_due) continue;
    const auto now = Clock::now();
    try {
      advance_frame();
    } catch (const StoppedError&) {
      return;
    }
    const Shown& first = *runs_.front();
    const double simulated = first.run.simulator().settings().step * steps_of_frame(first);
    const auto frame = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(play_.speed > 0.0 ? simulated / play_.speed : 0.0));
    due_ = std::max(due_ + frame, now);  // a simulation that is late does not hurry afterwards
  }
}

bool LiveSession::is_ending() {
  const std::lock_guard lock(mutex_);
  return ending_;
}

/// Waits until there are messages, the next frame is due, or it is time to look at the scene's file. Returns whether a frame is
/// due.
bool LiveSession::take_messages(std::vector<Message>& messages) {
  std::unique_lock lock(mutex_);
  const auto called = [&] { return ending_ || !messages_.empty(); };
  const auto runs = [&] { return play_.playing && watchers_ > 0 && !runs_.empty() && !all_diverged(); };
  if (!called() && !runs()) changed_.wait_for(lock, kLookInterval, [&] { return called() || runs(); });
  if (!called() && runs() && play_.speed > 0.0) changed_.wait_until(lock, due_, called);
  const bool is_due = !called() && runs();
  messages.assign(std::make_move_iterator(messages_.begin()), std::make_move_iterator(messages_.end()));
  messages_.clear();
  return is_due;
}

void LiveSession::obey(const Message& message) try {
  if (!message.is_last) {
    obey(message.client, PageCommand(message.text));
  } else if (message.client == puller_) {
    drop(false);
  }
} catch (const PageCommandError& error) {
  publisher_->tell(message.client, error_text(error.what()));
} catch (const StoppedError&) {
  return;
} catch (const std::exception& error) {
  publisher_->tell(message.client, error_text(std::string("this was not possible: ") + error.what()));
}

void LiveSession::obey(ClientId client, const PageCommand& command) {
  if (control(command) || interact(client, command)) return;
  if (command.name() == "set") {
    const auto run = command.has("run") ? std::optional(run_of(command).number) : std::nullopt;
    change(run, command.text("key"), command.json("value"));
  } else if (command.name() == "compare") {
    compare(command.text("integrator"));
  } else if (command.name() == "single") {
    end_comparison();
  } else if (command.name() == "open") {
    open({.file = example_of(command).file, .overrides = {}, .mesh_paths = first_source_.mesh_paths});
  } else if (command.name() == "picture") {
    tell_picture(client, example_of(command));
  } else if (command.name() == "scene") {
    tell_scene(client, command);
  } else if (command.name() == "save") {
    save(client, command);
  } else if (command.name() == "tension") {
    tell_tension(client, command);
  } else if (command.name() == "obj") {
    tell_obj(client, run_of(command), command.text("body"));
  } else {
    throw PageCommandError("there is no command " + command.name());
  }
}

/// Obeys commands about time; returns whether it was one.
bool LiveSession::control(const PageCommand& command) {
  const std::string& name = command.name();
  if (name == "play" || name == "pause") {
    play(name == "play");
  } else if (name == "step") {
    play(false);
    for (auto& shown : runs_) advance(*shown, 1);
  } else if (name == "frame") {
    play(false);
    advance_frame();
  } else if (name == "reset") {
    reset();
  } else if (name == "rewind") {
    go_back(command.number("time"));
  } else if (name == "every") {
    play_.every = static_cast<int>(command.integer("steps", 0, kMostStepsShownAtOnce));
    publish_state();
  } else if (name == "speed") {
    const double factor = command.number("factor");
    play_.speed = factor > 0.0 ? std::clamp(factor, kLeastSpeed, kGreatestSpeed) : 0.0;
    due_ = Clock::now();
    publish_state();
  } else {
    return false;
  }
  return true;
}

/// Obeys commands about particles; returns whether it was one.
bool LiveSession::interact(ClientId client, const PageCommand& command) {
  const auto particle = [&] { return static_cast<Index>(command.integer("particle", 0, std::numeric_limits<Index>::max())); };
  if (command.name() == "grab") {
    run_of(command).run.grab(particle());
    puller_ = client;
  } else if (command.name() == "drag") {
    for (auto& shown : runs_) shown->run.drag(command.vector("target"));
  } else if (command.name() == "drop") {
    drop(command.flag("pin"));
  } else if (command.name() == "release") {
    Shown& shown = run_of(command);
    attempt(shown.number, "", [&] { shown.run.release(particle()); });
    publish_frame(shown);
  } else {
    return false;
  }
  return true;
}

LiveSession::Shown& LiveSession::run_of(const PageCommand& command) {
  const auto number = command.has("run") ? command.integer("run", 0, 1) : 0;
  if (number >= static_cast<std::int64_t>(runs_.size())) throw PageCommandError("there is no such run");
  return *runs_[static_cast<std::size_t>(number)];
}

void LiveSession::play(bool playing) {
  play_.playing = playing;
  due_ = Clock::now();
  for (auto& shown : runs_) shown->measured_from = {};
  publish_state();
}

/// Without a run, because the scene had a mistake, loads the scene again.
void LiveSession::reset() {
  if (runs_.empty()) {
    open(first_source_);
    return;
  }
  for (const auto& shown : runs_) {
    attempt(shown->number, "", [&] {
      shown->run.reset();
      begin_run(shown->number, false);
    });
  }
}

const ExampleScene& LiveSession::example_of(const PageCommand& command) const {
  const std::string name = command.text("example");
  const auto found = std::ranges::find(examples_, name, &ExampleScene::name);
  if (found == examples_.end()) throw PageCommandError("there is no example " + name);
  return *found;
}

void LiveSession::tell_picture(ClientId client, const ExampleScene& example) {
  if (example.picture.empty()) throw PageCommandError("there is no picture of " + example.name);
  std::ifstream file(example.picture, std::ios::binary);
  const Bytes bytes(std::istreambuf_iterator<char>(file), {});
  publisher_->tell(client, picture_text(example.name, bytes));
}

/// A scene with mistakes leaves what is there. Returns whether the scene was opened.
bool LiveSession::open(const SceneSource& source) {
  bool is_open = false;
  attempt(std::nullopt, "", [&] {
    auto opened = std::make_unique<Shown>(0, source);
    if (!runs_.empty() && runs_.front()->run.source().file == source.file) opened->run.keep_pins(runs_.front()->run);
    end_comparison();
    runs_.clear();
    runs_.push_back(std::move(opened));
    publisher_->show_failure("");
    begin_run(0, false);
    is_open = true;
  });
  return is_open;
}

/// Opens a scene again whose file has changed: what the file says now holds, with the pins of the hand.
void LiveSession::look_at_file() {
  const auto now = Clock::now();
  if (first_source_.text || now - looked_ < kLookInterval) return;
  looked_ = now;
  const std::string file = runs_.empty() ? first_source_.file : runs_.front()->run.source().file;
  std::error_code missing;  // for a moment, as an editor replaces the file
  const auto written = std::filesystem::last_write_time(file, missing);
  if (missing || (file == watched_ && written == written_)) return;
  const bool has_changed = file == watched_;
  watched_ = file;
  written_ = written;
  if (!has_changed) return;
  SceneSource source{.file = file, .overrides = {}, .mesh_paths = first_source_.mesh_paths};
  if (file == first_source_.file) source.overrides = first_source_.overrides;
  if (open(source))
    publisher_->tell_all(notice_text(std::filesystem::path(file).filename().string() + " has changed and begins anew"));
}

void LiveSession::compare(const std::string& integrator) {
  if (runs_.empty()) return;
  attempt(1, "integrator", [&] {
    SceneSource source = runs_.front()->run.source();
    source.overrides.push_back("integrator={\"type\":" + Json(integrator).dump() + "}");
    auto second = std::make_unique<Shown>(1, std::move(source));
    second->run.keep_pins(runs_.front()->run);
    runs_.front()->run.reset();
    runs_.resize(1);
    runs_.push_back(std::move(second));
    begin_run(0, false);
    begin_run(1, false);
  });
}

void LiveSession::end_comparison() {
  if (runs_.size() < 2) return;
  publisher_->remove_run(runs_.back()->number, removed_text(runs_.back()->number));
  runs_.pop_back();
}

void LiveSession::change(std::optional<std::uint32_t> run, const std::string& key, const std::string& value) {
  for (const auto& shown : runs_) {
    if (run && *run != shown->number) continue;
    attempt(shown->number, key, [&] { begin_run(shown->number, shown->run.change({key + "=" + value})); });
  }
}

void LiveSession::drop(bool pin) {
  puller_ = 0;
  for (auto& shown : runs_) {
    shown->run.drop(pin);
    publish_frame(*shown);
  }
}

void LiveSession::tell_obj(ClientId client, const Shown& shown, const std::string& body_name) {
  const Simulator& simulator = shown.run.simulator();
  const std::vector<Body>& bodies = simulator.network().bodies;
  const auto body = std::ranges::find(bodies, body_name, &Body::name);
  if (body == bodies.end()) throw PageCommandError("there is no body " + body_name);
  const RunRecorder recorder(simulator, shown.run.loaded().sources, {});
  ExportedFrame frame{.state = RunRecorder::frame(simulator)};
  for (const Body& each : bodies) frame.torn.push_back(each.surface.torn);
  for (const ExportedFile& file : make_exporter("obj", {.model = recorder.model()})->frame(frame)) {
    const bool is_of_body = file.path.starts_with(body_name + "/") && file.path.ends_with(".obj");
    if (is_of_body) publisher_->tell(client, obj_message(body_name + ".obj", file.bytes));
  }
}

/// Runs without a state near enough go on from the one that they have.
void LiveSession::go_back(double time) {
  for (const auto& shown : runs_) {
    attempt(shown->number, "", [&] {
      const bool had_diverged = shown->run.failure().has_value();
      if (!shown->run.go_back(time)) return;
      shown->measured_from = {};
      const bool same_springs = shown->run.simulator().state().springs.broken_count() == shown->broken_springs;
      if (had_diverged || !same_springs) return begin_run(shown->number, true);
      publish_frame(*shown);
    });
  }
  if (runs_.empty()) return;
  const LiveRun& first = runs_.front()->run;
  const double frame = first.simulator().settings().step * first.simulator().settings().steps_per_frame;
  if (first.simulator().time() > time + frame) {
    publisher_->tell_all(
        notice_text("goes on from " + format_number(first.simulator().time(), 4) + " s: the program keeps no earlier state"));
  }
}

void LiveSession::tell_tension(ClientId client, const PageCommand& command) {
  const Shown& shown = run_of(command);
  const Simulator& simulator = shown.run.simulator();
  const auto spring = static_cast<Index>(command.integer("spring", 0, simulator.network().springs.count() - 1));
  const bool with_limit = !simulator.settings().stretch_limit || simulator.settings().record_forces;
  publisher_->tell(client, tension_text(shown.number, spring, spring_tensions(simulator)[spring], with_limit));
}

/// With a `state` the present one is saved under this name, and the scene begins from it.
void LiveSession::tell_scene(ClientId client, const PageCommand& command) {
  const Shown& shown = run_of(command);
  if (!command.has("state")) return publisher_->tell(client, changed_text(shown.number, shown.run));
  const std::string name = command.text("state");
  attempt_to_save(client, [&] {
    const std::filesystem::path folder = new_path(save_folder(), name);
    shown.run.save(folder);
    const auto scene_folder = std::filesystem::absolute(shown.run.source().file).parent_path();
    publisher_->tell(client, changed_text(shown.number, shown.run, folder.lexically_proximate(scene_folder).generic_string()));
    return saved_text(name, "The present state is in " + folder.string() + ". The scene begins from it.");
  });
}

void LiveSession::save(ClientId client, const PageCommand& command) {
  const std::string name = command.text("name");
  const std::string as = command.text("as");
  if (as != "run" && as != "page") throw PageCommandError("a run is saved as run or page, not as " + as);
  attempt_to_save(client, [&] {
    // All names are checked before anything is written.
    std::vector<std::filesystem::path> paths;
    for (const auto& shown : runs_) {
      const std::string own = shown->number == 0 ? name : name + "_" + integrator_name(shown->run.simulator());
      paths.push_back(new_path(save_folder(), own, as == "page" ? ".html" : ""));
    }
    std::string text;
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      const LiveRun& run = runs_[k]->run;
      if (as == "page") {
        save_page(run, paths[k]);
      } else {
        run.save(paths[k]);
      }
      if (run.saved_frames() < run.frame()) text += "Only the first, as memory ended there: ";
      text += counted(run.saved_frames(), "frame") + ": " + paths[k].string() + ". ";
    }
    text += as == "page" ? "A page plays in any browser." : "sprung view and sprung export read such folders.";
    return saved_text(name, text);
  });
}

/// Tells the page what `save` says, or why it could not.
template <class Save>
void LiveSession::attempt_to_save(ClientId client, const Save& save) try {
  publisher_->tell(client, save());
} catch (const InputError& error) {
  publisher_->tell(client, saved_text("", error.what()));
} catch (const FileError& error) {
  publisher_->tell(client, saved_text("", error.what()));
}

/// Beside the scene, unless another folder was given.
std::filesystem::path LiveSession::save_folder() const {
  const std::filesystem::path folder =
      save_to_.empty() ? std::filesystem::path(runs_.front()->run.source().file).parent_path() : save_to_;
  return std::filesystem::absolute(folder).lexically_normal();
}

/// Shows the problems of an action that the scene does not permit.
template <class Action>
void LiveSession::attempt(std::optional<std::uint32_t> run, const std::string& key, const Action& action) try {
  action();
} catch (const InputError& error) {
  refuse(run, key, error.problems());
} catch (const FileError& error) {
  refuse(run, key, {Problem{.rule = error.what()}});
}

void LiveSession::refuse(std::optional<std::uint32_t> run, const std::string& key, const std::vector<Problem>& problems) {
  if (tell_problems_) tell_problems_(problems);
  const std::string text = problems_text(runs_.empty() ? std::nullopt : run, key, problems);
  if (runs_.empty()) {
    publisher_->show_failure(text);
  } else {
    publisher_->tell_all(text);
  }
}

/// Shows a run anew; `live` says whether its state goes on.
void LiveSession::begin_run(std::uint32_t number, bool live) {
  Shown& shown = *runs_.at(number);
  shown.generation = next_generation_++;
  shown.told_divergence = false;
  shown.measured_from = {};
  shown.broken_springs = shown.run.simulator().state().springs.broken_count();
  due_ = Clock::now();
  shown.run.stop_when([this] { return is_ending(); });
  const MessageHeader header{
      .run = number, .generation = shown.generation, .frame = shown.run.frame(), .time = shown.run.simulator().time()};
  publisher_->show_scene(number, scene_text(number, shown.generation, live, shown.run),
                         std::make_shared<const Bytes>(topology_message(header, shown.run.topology())));
  publish_frame(shown);
}

void LiveSession::advance_frame() {
  for (auto& shown : runs_) advance(*shown, steps_of_frame(*shown));
}

void LiveSession::advance(Shown& shown, int steps) {
  const auto begin = Clock::now();
  if (shown.measured_from == Clock::time_point{}) {
    shown.measured_from = begin;
    shown.measured_time = shown.run.simulator().time();
  }
  for (int k = 0; k < steps; ++k) shown.run.step();
  shown.frame_ms = 1e3 * seconds_between(begin, Clock::now());
  if (!shown.run.failure() && shown.run.simulator().state().springs.broken_count() != shown.broken_springs) {
    return begin_run(shown.number, true);  // with the topology that is left
  }
  publish_frame(shown);
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

/// Runs with different steps stay at the same time: `every` counts the steps of the first one.
int LiveSession::steps_of_frame(const Shown& shown) const {
  if (play_.every == 0) return shown.run.loaded().simulator.settings().steps_per_frame;
  const double steps = play_.every * runs_.front()->run.simulator().settings().step / shown.run.simulator().settings().step;
  return static_cast<int>(std::clamp(std::round(steps), 1.0, static_cast<double>(kMostStepsShownAtOnce)));
}

bool LiveSession::all_diverged() const {
  return std::ranges::all_of(runs_, [](const auto& shown) { return shown->run.failure().has_value(); });
}

}  // namespace sprung
