#include "scene/format/text_problems.h"

#include <algorithm>

namespace sprung {
namespace {

bool is_within(const std::string& path, const std::string& key) {
  if (!path.starts_with(key)) return false;
  return path.size() == key.size() || path[key.size()] == '.' || path[key.size()] == '[';
}

}  // namespace

bool TextProblems::affect(const std::string& key) const {
  if (only_unknown_keys) return false;
  return std::ranges::any_of(all, [&](const Problem& problem) { return is_within(problem.key, key); });
}

}  // namespace sprung
