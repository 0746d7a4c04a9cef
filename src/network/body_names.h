// Names of bodies in warnings.
#pragma once

#include <string>
#include <vector>

namespace sprung {

/// `body "a"`, `bodies "a" and "b"`, `bodies "a", "b" and 22 more`. Requires a name.
[[nodiscard]] inline std::string bodies_text(const std::vector<std::string>& names) {
  const auto quoted = [&](std::size_t k) { return "\"" + names[k] + "\""; };
  if (names.size() == 1) return "body " + quoted(0);
  if (names.size() == 2) return "bodies " + quoted(0) + " and " + quoted(1);
  return "bodies " + quoted(0) + ", " + quoted(1) + " and " + std::to_string(names.size() - 2) + " more";
}

}  // namespace sprung
