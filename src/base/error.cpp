#include "base/error.h"

#include "base/format.h"

#include <utility>

namespace sprung {
namespace {

// A time is a product of steps: its last digits are rounding error.
constexpr int kTimeDigits = 9;

/// Text from files as one line that every terminal shows: control characters become \xNN.
std::string printable(const std::string& text) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      result += {'\\', 'x', kDigits[byte / 16], kDigits[byte % 16]};
    } else {
      result += c;
    }
  }
  return result;
}

std::string join_lines(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += to_string(problem);
  }
  return text;
}

std::string describe(const StepFailure& failure) {
  std::string text = "the simulation diverged at step " + std::to_string(failure.step) + ", time " +
                     format_number(failure.time, kTimeDigits) + " s: " + failure.cause;
  std::string location;
  if (!failure.body.empty()) location += "body \"" + failure.body + "\"";
  if (failure.particle != kNone) location += (location.empty() ? "" : ", ") + ("particle " + std::to_string(failure.particle));
  if (failure.spring != kNone) location += (location.empty() ? "" : ", ") + ("spring " + std::to_string(failure.spring));
  if (!location.empty()) text += " (" + location + ")";
  if (!failure.remedy.empty()) text += "; " + failure.remedy;
  return text;
}

}  // namespace

std::string to_string(const Problem& problem) {
  std::string location = problem.key;
  if (!problem.value.empty()) location += (location.empty() ? "" : " = ") + problem.value;
  std::string text;
  for (const std::string& field : {problem.file, location, problem.rule}) {
    if (field.empty()) continue;
    if (!text.empty()) text += ": ";
    text += field;
  }
  if (!problem.remedy.empty()) text += "; " + problem.remedy;
  return printable(text);
}

InputError::InputError(Problem problem) : InputError(std::vector<Problem>{std::move(problem)}) {}

InputError::InputError(std::vector<Problem> problems) : std::runtime_error(join_lines(problems)), problems_(std::move(problems)) {}

FileError::FileError(const std::string& action, const std::string& path, const std::string& reason)
    : std::runtime_error(path + ": cannot " + action + ": " + reason) {}

StepError::StepError(StepFailure failure) : std::runtime_error(describe(failure)), failure_(std::move(failure)) {}

}  // namespace sprung
