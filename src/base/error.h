// The errors that Sprung throws. Each states the problem, its location and a remedy.
#pragma once

#include "base/types.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace sprung {

/// One broken rule of an input. Empty members are left out of the text.
struct Problem {
  std::string file{};
  std::string key{};     ///< path of the key or location in the file: `bodies.banner.mass`, `line 12`
  std::string value{};   ///< the invalid value as the user wrote it
  std::string rule{};    ///< the rule: `must be greater than 0`
  std::string remedy{};  ///< what to change: `did you mean "stiffness"?`

  bool operator==(const Problem&) const = default;
};

/// One line: `file: key = value: rule; remedy`.
[[nodiscard]] std::string to_string(const Problem& problem);

/// Invalid scene, mesh or argument, with all problems found. Requires at least one problem.
class InputError : public std::runtime_error {
 public:
  explicit InputError(Problem problem);
  explicit InputError(std::vector<Problem> problems);

  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// A scene file that cannot be read, or an output that cannot be written.
class FileError : public std::runtime_error {
 public:
  /// `action` completes "cannot ...": `write`, `create the folder`.
  FileError(const std::string& action, const std::string& path, const std::string& reason);
};

/// The location of a divergence. `particle` and `spring` are counted within the body; kNone if no spring is involved.
struct StepFailure {
  std::int64_t step = 0;
  double time = 0.0;  ///< [s]
  std::string body;
  Index particle = kNone;
  Index spring = kNone;
  std::string cause;   ///< the observation: `a position is not finite`
  std::string remedy;  ///< what to change
  /// A smaller step [s] that the remedy names; none if it names no step, or no step alone.
  std::optional<double> smaller_step;
};

/// The simulation diverged. Simulator::step then leaves the simulator as it was before the step.
class StepError : public std::runtime_error {
 public:
  explicit StepError(StepFailure failure);

  [[nodiscard]] const StepFailure& failure() const { return failure_; }

 private:
  StepFailure failure_;
};

}  // namespace sprung
