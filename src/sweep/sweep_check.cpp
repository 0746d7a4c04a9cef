#include "sweep/sweep_check.h"

#include "base/error.h"
#include "base/format.h"
#include "scene/reading/scene_reader.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace sprung {
namespace {

/// The problems of the scenes of a sweep, as its user knows them.
class SweepProblems {
 public:
  SweepProblems(const SceneSource& scene, const SweepRequest& request) : scene_(scene) {
    const auto add = [this](const char* option, const std::vector<std::string>& given) {
      if (!given.empty()) options_ += (options_.empty() ? "" : " or ") + std::string(option);
    };
    add("--set", scene.overrides);
    add("--vary", request.vary);
    add("--sample", request.sample);
  }

  void add(const std::vector<Problem>& more) {
    constexpr std::string_view kSet = "--set";
    for (Problem problem : more) {
      if (problem.key == kSet) problem.key = options_;
      if (problem.file.ends_with(kSet)) problem.file.replace(problem.file.size() - kSet.size(), kSet.size(), options_);
      if (scene_.text && problem.file.starts_with(scene_.file)) problem.file.replace(0, scene_.file.size(), "standard input");
      add_new(std::move(problem));
    }
  }

  /// Throws InputError if there are any.
  void throw_if_any() {
    for (auto& [sample, count] : not_named_) {
      Problem rest = sample;
      rest.value = counted(count, "more value");
      all_.push_back(std::move(rest));
    }
    if (!all_.empty()) throw InputError(std::move(all_));
  }

 private:
  /// Of values that break one rule of a key, the first ones alone are named.
  void add_new(Problem problem) {
    constexpr std::ptrdiff_t kMostNamed = 5;
    if (std::ranges::find(all_, problem) != all_.end()) return;
    const auto is_alike = [&](const Problem& other) {
      return other.file == problem.file && other.key == problem.key && other.rule == problem.rule;
    };
    if (std::ranges::count_if(all_, is_alike) < kMostNamed) {
      all_.push_back(std::move(problem));
      return;
    }
    const auto found = std::ranges::find_if(not_named_, is_alike, &std::pair<Problem, std::size_t>::first);
    if (found == not_named_.end()) {
      not_named_.emplace_back(std::move(problem), 1);
    } else {
      ++found->second;
    }
  }

  const SceneSource& scene_;
  std::string options_{};  ///< that change the scene
  std::vector<Problem> all_{};
  std::vector<std::pair<Problem, std::size_t>> not_named_{};  ///< one of each kind, and their number
};

void check_run(const SweepFolder& sweep, int run) {
  SceneSource source = sweep.settings().scene;
  for (const std::string& change : overrides_of(sweep.plan(), run)) source.overrides.push_back(change);
  (void)prepare_scene(source);
}

}  // namespace

std::string checked_scene(const SceneSource& scene, const SweepRequest& request, std::size_t most) {
  const SweepPlan plan(request);
  const std::string text = scene_text(scene);
  SweepProblems problems(scene, request);
  const auto resolve = [&](const std::vector<std::string>& values) {
    std::vector<std::string> overrides = scene.overrides;
    for (std::size_t key = 0; key < values.size(); ++key) overrides.push_back(plan.keys()[key] + "=" + values[key]);
    TextProblems found;
    std::string resolved;
    try {
      resolved = read_scene_text(text, scene.file, overrides, found).resolved;
    } catch (const InputError& error) {
      found.all = error.problems();
    }
    problems.add(found.all);
    return resolved;
  };
  const std::vector<std::string> first = plan.values_of(1);
  std::string resolved = resolve(first);
  for (std::size_t key = 0; key < first.size(); ++key) {
    const std::vector<std::string>& all = plan.values_of_key(key);
    for (std::size_t k = 0; k < std::min(all.size(), most); ++k) {
      const std::string& value = all[k];
      std::vector<std::string> values = first;
      values[key] = value;
      if (value != first[key]) resolve(values);
    }
  }
  problems.throw_if_any();
  return resolved;
}

void check_meshes_and_bodies(const SweepFolder& sweep) {
  SweepProblems problems(sweep.settings().scene, sweep.settings().request);
  for (const int run : {1, sweep.plan().run_count()}) {
    try {
      check_run(sweep, run);
      return;
    } catch (const InputError& error) {
      if (run == 1) problems.add(error.problems());
    }
  }
  problems.throw_if_any();
}

void SceneWatch::check() {
  std::error_code unreadable;
  const std::filesystem::file_time_type time = std::filesystem::last_write_time(sweep_.settings().scene.file, unreadable);
  if (!unreadable && seen_ == time) return;
  SweepSettings settings = sweep_.settings();
  settings.scene.text.reset();
  settings.first_scene = checked_scene(settings.scene, settings.request, 1);
  SweepFolder(sweep_.path(), std::move(settings)).check_is_same_or_free();
  seen_ = time;
}

}  // namespace sprung
