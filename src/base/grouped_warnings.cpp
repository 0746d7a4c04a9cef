#include "base/grouped_warnings.h"

#include <algorithm>

namespace sprung {

void GroupedWarnings::add(const std::string& name, const std::string& text) {
  const auto known = std::ranges::find(names_, text, [](const auto& entry) { return entry.first; });
  if (known != names_.end()) return known->second.push_back(name);
  names_.push_back({text, {name}});
}

std::vector<std::string> GroupedWarnings::lines() const {
  std::vector<std::string> lines;
  for (const auto& [text, names] : names_) lines.push_back(names_text(one_, several_, names) + ": " + text);
  return lines;
}

std::string names_text(const std::string& one, const std::string& several, const std::vector<std::string>& names) {
  const auto quoted = [&](std::size_t k) { return "\"" + names[k] + "\""; };
  if (names.size() == 1) return one + " " + quoted(0);
  if (names.size() == 2) return several + " " + quoted(0) + " and " + quoted(1);
  return several + " " + quoted(0) + ", " + quoted(1) + " and " + std::to_string(names.size() - 2) + " more";
}

}  // namespace sprung
