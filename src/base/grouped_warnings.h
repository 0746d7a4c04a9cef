// Warnings about bodies or obstacles: equal ones are told once, with all names.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sprung {

/// `body "a"`, `bodies "a" and "b"`, `bodies "a", "b" and 22 more`, for "body" and "bodies". Requires a name.
[[nodiscard]] std::string names_text(const std::string& one, const std::string& several, const std::vector<std::string>& names);

class GroupedWarnings {
 public:
  /// What the named things are, such as "body" and "bodies".
  GroupedWarnings(std::string one, std::string several) : one_(std::move(one)), several_(std::move(several)) {}

  void add(const std::string& name, const std::string& text);

  /// `body "a": text`, `bodies "a" and "b": text` and so on, in the order in which texts were added.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  std::string one_;
  std::string several_;
  std::vector<std::pair<std::string, std::vector<std::string>>> names_;  ///< by text
};

}  // namespace sprung
