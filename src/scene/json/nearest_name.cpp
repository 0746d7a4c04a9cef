#include "scene/json/nearest_name.h"

#include "base/format.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace sprung {
namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before_previous;
  std::vector<std::size_t> previous(b.size() + 1);
  std::vector<std::size_t> current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        current[j] = std::min(current[j], before_previous[j - 2] + 1);
    }
    before_previous = previous;
    previous = current;
  }
  return previous[b.size()];
}

std::size_t distance_of(const std::string& word, const std::string& name) {
  constexpr std::size_t kShortestBeginning = 3;
  const bool one_begins_the_other = word.starts_with(name) || name.starts_with(word);
  if (one_begins_the_other && std::min(word.size(), name.size()) >= kShortestBeginning && word != name) return 1;
  return edit_distance(word, name);
}

/// In lower case, between underscores.
std::string framed(std::string_view word) { return std::string("_").append(lower_case(std::string(word))).append("_"); }

/// The names that consist of `word` and other words, joined by underscores.
std::vector<std::string> names_with(std::string_view word, const std::vector<std::string>& names) {
  const std::string given = framed(word);
  std::vector<std::string> result;
  for (const std::string& name : names) {
    if (framed(name).find(given) != std::string::npos) result.push_back(name);
  }
  return result;
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view word, const std::vector<std::string>& names) {
  constexpr std::size_t kShortWord = 4;     // two different letters make another word: a cube is not a cone
  constexpr std::size_t kLongestWord = 64;  // a longer word is not a misspelt name, and comparing it takes long
  if (word.size() > kLongestWord) return std::nullopt;
  const std::size_t most = word.size() <= kShortWord ? 1 : std::max<std::size_t>(2, word.size() / 3);
  std::optional<std::string> best;
  std::pair best_distance(most, std::numeric_limits<std::size_t>::max());
  for (const std::string& name : names) {
    const std::string known = lower_case(std::string(name));
    const std::string given = lower_case(std::string(word));
    const std::pair distance(distance_of(given, known), edit_distance(given, known));
    if (distance < best_distance && distance.first < std::max(name.size(), word.size())) {
      best = name;
      best_distance = distance;
    }
  }
  return best;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 3;
  std::vector<std::string> meant = names_with(word, names);
  if (meant.empty() || meant.size() > kMost) {
    const auto near = nearest_name(word, names);
    if (!near) return "";
    meant = {*near};
  }
  std::string text = "did you mean \"" + meant.front() + "\"";
  for (std::size_t k = 1; k < meant.size(); ++k) text += (k + 1 < meant.size() ? ", \"" : " or \"") + meant[k] + "\"";
  return text + "?";
}

std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
  const std::string meant = did_you_mean(word, names);
  return meant.empty() ? "choose from " + joined(names) : meant;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace sprung
