#include "geometry/obj_source/obj_lines.h"

#include "geometry/import/text_words.h"

namespace sprung {

void read_obj_line(std::string_view text, std::size_t begin, ObjLine& line) {
  line.words.clear();
  bool in_comment = false;
  bool in_word = false;
  std::size_t word_begin = begin;
  const auto end_word = [&](std::size_t end) {
    if (in_word && end > word_begin) line.words.push_back({word_begin, end});
    in_word = false;
  };
  std::size_t i = begin;
  for (; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n' || c == '\r') {
      const std::size_t last = c == '\r' && i + 1 < text.size() && text[i + 1] == '\n' ? i + 1 : i;
      const bool continued = !in_comment && i > begin && text[i - 1] == '\\';
      end_word(continued ? i - 1 : i);
      if (!continued) {
        line.line_end = i;
        line.whole = {begin, last + 1};
        return;
      }
      i = last;
    } else if (is_blank(c) || c == '\0') {
      end_word(i);
    } else if (c == '#' && !in_word) {
      in_comment = true;
    } else if (!in_comment && !in_word) {
      in_word = true;
      word_begin = i;
    }
  }
  end_word(text.size());
  line.line_end = text.size();
  line.whole = {begin, text.size()};
}

}  // namespace sprung
