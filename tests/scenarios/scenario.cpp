#include "scenarios/scenario.h"

#include "base/format.h"
#include "scenarios/judge.h"
#include "scenarios/position_hash.h"
#include "scenarios/resume_check.h"
#include "scene/reading/scene_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <limits>
#include <memory>
#include <ostream>
#include <sstream>
#include <utility>

namespace sprung::testing {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Positions in an obstacle's own frame.
Points local_positions(const Obstacle& obstacle, const Simulator& simulator) {
  return obstacle.motion.pose(obstacle.rest_pose, simulator.time()).inverse() * simulator.positions();
}

class FrameJudge {
 public:
  FrameJudge(const Simulator& simulator, Judge judge)
      : simulator_(simulator), elements_(judged_elements(simulator.network())), self_(judge == Judge::obstacles_and_self) {
    if (judge == Judge::nothing) return;
    for (const Obstacle& obstacle : simulator.obstacles()) judges_.push_back(judge_of(obstacle.geometry));
  }

  void look(int frame, ScenarioReport& report) {
    const auto begin = Clock::now();
    if (broken_springs_ != simulator_.state().springs.broken_count()) {
      broken_springs_ = simulator_.state().springs.broken_count();
      elements_ = judged_elements(simulator_.network());
    }
    Index inside = 0;
    Index crossings = 0;
    for (std::size_t k = 0; k < judges_.size(); ++k) {
      const Obstacle& obstacle = simulator_.obstacles()[k];
      if (std::holds_alternative<SequenceGeometry>(obstacle.geometry)) judges_[k] = judge_of(obstacle.geometry, simulator_.time());
      const Points local = local_positions(obstacle, simulator_);
      inside += judges_[k]->count_inside(contact_positions(simulator_.network(), local));
      crossings += judges_[k]->count_crossings(elements_, local);
    }
    const Index self_crossings = self_ ? count_self_crossings(elements_, simulator_.positions()) : 0;
    report.inside += inside;
    report.crossings += crossings;
    report.self_crossings += self_crossings;
    if (inside + crossings + self_crossings > 0) {
      report.last_wrong_frame = frame;
      if (report.first_wrong_frame == 0) report.first_wrong_frame = frame;
    }
    report.judge_seconds += seconds_since(begin);
  }

 private:
  const Simulator& simulator_;
  std::vector<JudgedElement> elements_;
  Index broken_springs_ = 0;  ///< when the elements were listed
  std::vector<std::unique_ptr<const ObstacleJudge>> judges_;
  bool self_;
};

/// Appends one line to the file that SPRUNG_SCENARIO_HASHES names, when the run ends or throws: the hash of the positions of all
/// frames, the number of frames, and the test. tests/compare_scenarios.sh compares two such files.
class HashRecord {
 public:
  HashRecord() : file_(std::getenv("SPRUNG_SCENARIO_HASHES")) {}
  HashRecord(const HashRecord&) = delete;
  HashRecord& operator=(const HashRecord&) = delete;
  ~HashRecord() {
    if (file_ == nullptr) return;
    const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
    std::ostringstream line;
    line << std::hex << std::setw(16) << std::setfill('0') << hash_.value() << std::dec << ' ' << frames_ << ' '
         << test.test_suite_name() << '.' << test.name() << '\n';
    std::ofstream(file_, std::ios::app) << line.str();
  }

  void add(const Points& positions) {
    if (file_ == nullptr) return;
    hash_.add(positions);
    ++frames_;
  }

 private:
  const char* file_;
  PositionHash hash_;
  int frames_ = 0;
};

}  // namespace

BuiltScene load_scenario(const std::string& name, const std::vector<std::string>& overrides, double step_factor) {
  const std::filesystem::path root = SPRUNG_SOURCE_DIR;
  const std::filesystem::path file = root / "tests" / "scenarios" / "scenes" / (name + ".json");
  const std::vector<std::filesystem::path> meshes = {root / "meshes", SPRUNG_TEST_MESHES};
  std::vector<std::string> changes = {"sleep=false"};  // laws of rest are judged awake
  changes.insert(changes.end(), overrides.begin(), overrides.end());
  BuiltScene built = build_scene(read_scene(file, changes), meshes);
  built.settings.step *= step_factor;
  if (step_factor < 1.0) {
    built.settings.steps_per_frame = static_cast<int>(std::lround(built.settings.steps_per_frame / step_factor));
  } else {
    built.frames = static_cast<int>((built.frames - 1) / step_factor) + 1;
  }
  return built;
}

BuiltScene load_stiff_scenario(const std::string& name, double step_factor) {
  BuiltScene built = load_scenario(name, {}, step_factor);
  if (step_factor > 1.0) {
    built.settings.integrator = ImplicitEulerSettings{};
    built.settings.inner_substeps = 1;
  }
  return built;
}

std::ostream& operator<<(std::ostream& stream, const ScenarioReport& report) {
  return stream << report.frames << " frames in steps of " << format_number(report.step, 4) << " s: " << report.inside
                << " inside, " << report.crossings << " crossings, " << report.self_crossings << " self-crossings, in frames "
                << report.first_wrong_frame << " to " << report.last_wrong_frame << "; stretch "
                << format_number(report.max_stretch, 3) << ", " << report.truncated << " truncated, " << report.infeasible
                << " infeasible, " << report.inverted << " inverted; simulated in " << format_number(report.simulation_seconds, 3)
                << " s, judged in " << format_number(report.judge_seconds, 3) << " s";
}

ScenarioReport run_scenario(BuiltScene scene, const Watch& watch, Judge judge) {
  ScenarioReport report = run_until_divergence(std::move(scene), watch, judge, {});
  if (report.divergence) throw StepError(*report.divergence);
  return report;
}

ScenarioReport run_until_divergence(BuiltScene scene, const Watch& watch, Judge judge, const std::function<bool()>& stops) {
  Simulator simulator(std::move(scene.network), scene.settings, std::move(scene.obstacles));
  if (stops) simulator.stop_when(stops);
  FrameRunner runner(simulator);
  FrameJudge frame_judge(simulator, judge);
  HashRecord record;
  ResumeCheck resume(scene.frames);
  ScenarioReport report{.step = scene.settings.step};
  for (int number = 1; number <= scene.frames; ++number) {
    FrameDiagnostics frame;
    StepReport before;
    try {
      if (number > 1) resume.begin(number, simulator, before);
      frame = number == 1 ? runner.first_frame() : runner.next_frame();
    } catch (const StepError& error) {
      report.divergence = error.failure();
      return report;
    }
    report.frames = number;
    record.add(simulator.positions());
    report.max_stretch = std::max(report.max_stretch, frame.max_stretch);
    frame.truncated += before.truncated;
    frame.infeasible += before.infeasible;
    frame.substeps += before.substeps;
    report.truncated += frame.truncated;
    report.infeasible += frame.infeasible;
    if (frame.infeasible > 0 && report.first_infeasible_frame == 0) report.first_infeasible_frame = number;
    report.simulation_seconds += 1e-3 * frame.frame_ms;
    frame_judge.look(number, report);
    if (watch) watch(simulator, frame);
  }
  for (const Body& body : simulator.network().bodies) {
    if (!body.preserve_volume) continue;
    report.inverted += count_inverted(body.cells, simulator.positions().middleCols(body.first_particle, body.particle_count));
  }
  return report;
}

std::string json_text(const Vector3& v) {
  std::string text = "[";
  text.append(format_number(v.x())).append(",").append(format_number(v.y())).append(",").append(format_number(v.z())).append("]");
  return text;
}

double least_distance(const Simulator& simulator) {
  double least = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : simulator.obstacles()) {
    const auto judge = judge_of(obstacle.geometry, simulator.time());
    const Points local = local_positions(obstacle, simulator);
    for (const auto& position : local.colwise()) least = std::min(least, judge->distance(position));
  }
  return least;
}

}  // namespace sprung::testing
