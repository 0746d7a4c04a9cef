#include "geometry/import/text_words.h"

#include <algorithm>

namespace sprung {

void split_words(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  for (auto at = line.begin(); at != line.end();) {
    const auto begin = std::find_if_not(at, line.end(), is_blank);
    at = std::find_if(begin, line.end(), is_blank);
    if (begin != at) words.emplace_back(begin, at);
  }
}

std::string_view take_line(std::string_view& text) {
  const auto is_end = [](char c) { return c == '\n' || c == '\r'; };
  const auto end = std::find_if(text.begin(), text.end(), is_end);
  const std::string_view line(text.begin(), end);
  text.remove_prefix(line.size());
  text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, text.size()));
  return line;
}

}  // namespace sprung
