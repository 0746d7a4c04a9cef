#include "base/problem_list.h"

#include "base/format.h"

#include <cmath>

namespace sprung {

void ProblemList::require_positive(const std::string& key, double value, const std::string& remedy) {
  if (value > 0.0 && std::isfinite(value)) return;
  add(key, format_number(value), "must be a finite number greater than 0", remedy);
}

void ProblemList::require_not_negative(const std::string& key, double value, const std::string& remedy) {
  if (value >= 0.0 && std::isfinite(value)) return;
  add(key, format_number(value), "must be a finite number not less than 0", remedy);
}

void ProblemList::require_count(const std::string& key, std::int64_t value, std::int64_t least) {
  if (value >= least) return;
  add(key, std::to_string(value), "must be at least " + std::to_string(least), "give more");
}

std::string entry_key(const std::string& key, std::size_t entry) {
  std::string text = key;
  text += '[';
  text += std::to_string(entry);
  text += ']';
  return text;
}

std::string vector_text(const Vector3& vector) { return vector_text(vector, 0); }

std::string vector_text(const Vector3& vector, int digits) {
  std::string text;
  for (const double coordinate : vector) {
    text += text.empty() ? "[" : ", ";
    text += digits == 0 ? format_number(coordinate) : format_number(coordinate, digits);
  }
  text += ']';
  return text;
}

std::string counts_text(std::span<const Index> counts) {
  std::string text = "[";
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (i > 0) text += ", ";
    text += std::to_string(counts[i]);
  }
  text += ']';
  return text;
}

}  // namespace sprung
