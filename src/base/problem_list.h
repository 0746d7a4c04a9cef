// Collects the broken rules of an input, so that all are reported together.
#pragma once

#include "base/error.h"

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace sprung {

/// A rule for each entry of the array with the key `key`.
struct EntryRule {
  std::string key;
  std::string text;
  std::string remedy;
};

class ProblemList {
 public:
  void add(std::string key, std::string value, std::string rule, std::string remedy) {
    problems_.push_back({{}, std::move(key), std::move(value), std::move(rule), std::move(remedy)});
  }

  /// Greater than 0 and finite.
  void require_positive(const std::string& key, double value, const std::string& remedy);

  /// Not less than 0 and finite.
  void require_not_negative(const std::string& key, double value, const std::string& remedy);

  void require_count(const std::string& key, std::int64_t value, std::int64_t least);

  /// Names the first of `count` entries for which `good(entry)` is false, by `text(entry)`, and counts the others.
  template <class Good, class Text>
  void require_each(std::size_t count, const Good& good, const Text& text, const EntryRule& rule);

  [[nodiscard]] bool empty() const { return problems_.empty(); }

  /// Throws InputError with all problems, if there are any.
  void throw_if_any() const {
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  std::vector<Problem> problems_;
};

/// `points[3]`
[[nodiscard]] std::string entry_key(const std::string& key, std::size_t entry);

/// `[1, nan, 0]`
[[nodiscard]] std::string vector_text(const Vector3& vector);

/// Rounded to this number of significant digits, for display.
[[nodiscard]] std::string vector_text(const Vector3& vector, int digits);

/// `[64, 64]`
[[nodiscard]] std::string counts_text(std::span<const Index> counts);

template <class Good, class Text>
void ProblemList::require_each(std::size_t count, const Good& good, const Text& text, const EntryRule& rule) {
  std::size_t first = count;
  std::size_t broken = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (good(i)) continue;
    if (broken++ == 0) first = i;
  }
  if (broken == 0) return;
  std::string value = text(first);
  if (broken > 1) value += " (and " + std::to_string(broken - 1) + " more)";
  add(entry_key(rule.key, first), value, rule.text, rule.remedy);
}

}  // namespace sprung
