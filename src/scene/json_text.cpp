#include "scene/json_text.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <set>
#include <utility>

namespace sprung {
namespace {

constexpr std::size_t kDeepest = 64;  // no scene is deeper, and recursive readers must not run out of stack

struct TextPlace {
  std::size_t line = 1;
  std::size_t column = 1;
};

TextPlace place_of(std::string_view text, std::size_t offset) {
  const std::string_view head = text.substr(0, std::min(offset, text.size()));
  const std::size_t line_begin = head.rfind('\n') == std::string_view::npos ? 0 : head.rfind('\n') + 1;
  return {1 + static_cast<std::size_t>(std::count(head.begin(), head.end(), '\n')), 1 + head.size() - line_begin};
}

std::string_view trimmed_right(std::string_view text) {
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  return last == std::string_view::npos ? std::string_view{} : text.substr(0, last + 1);
}

bool is_literal_of_no_number(std::string_view rest) {
  for (const std::string_view word : {"NaN", "nan", "-NaN", "-nan", "Infinity", "-Infinity", "inf", "-inf"}) {
    if (rest.starts_with(word)) return true;
  }
  return false;
}

/// What most often is wrong at `offset`, the first character that does not fit, and what to do about it.
std::pair<std::string, std::string> explain_syntax(std::string_view text, std::size_t offset) {
  if (trimmed_right(text).empty()) return {"is empty", "write a scene, beginning with {"};
  const std::string_view rest = text.substr(std::min(offset, text.size()));
  const std::string_view before = trimmed_right(text.substr(0, std::min(offset, text.size())));
  if (trimmed_right(rest).empty()) return {"ends too early: brackets or quotes are not closed", "is the file complete?"};
  if (rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with("#")) return {"JSON has no comments", "remove it"};
  if (is_literal_of_no_number(rest)) return {"is not a number that JSON knows", "write a finite number"};
  if (before.ends_with(',') && (rest.front() == '}' || rest.front() == ']')) {
    return {"nothing follows the comma", "remove the comma before it"};
  }
  if (rest.front() == '\'') return {"is not JSON", "put strings and keys in double quotes"};
  return {"is not JSON", "check for a missing comma, quote or bracket just before it"};
}

/// Builds the document from parser events, because the library's own builder silently keeps the last of duplicate keys.
class DocumentBuilder final : public nlohmann::json_sax<Json> {
 public:
  DocumentBuilder(std::string_view text, const std::string& file, JsonText& result) : text_(text), file_(file), result_(result) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }

  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& key) override {
    Level& level = levels_.back();
    level.key = std::move(key);
    if (!level.keys.insert(level.key).second) {
      result_.problems.push_back({file_, path_of_next(), "", "is written twice in the same object", "keep one of them"});
    }
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token, const nlohmann::detail::exception& error) override {
    constexpr int kNumberOverflow = 406;
    // The parser counts the characters it has read, the last of them the one that ended the offending token.
    const std::size_t end = std::min(position, text_.size());
    if (error.id == kNumberOverflow) {
      fail(end - std::min(end, token.size()), token, "is too large for a number", "write a number below 1e308");
      return false;
    }
    const std::size_t begin = start_of_mistake(position, token);
    const auto [rule, remedy] = explain_syntax(text_, begin);
    fail(begin, std::string(first_word(begin)), rule, remedy);
    return false;
  }

 private:
  struct Level {
    Json value;
    std::string key;
    std::set<std::string> keys;
    std::string path;
  };

  /// The parser's `token` reaches back to the last string or number, so it counts only when it is one of them as a whole.
  [[nodiscard]] std::size_t start_of_mistake(std::size_t position, const std::string& token) const {
    if (position > text_.size()) return text_.size();
    const bool is_string = token.size() > 1 && token.front() == '"' && token.back() == '"';
    const bool is_number = !token.empty() && token.find_first_not_of("0123456789+-.eE") == std::string::npos;
    if ((is_string || is_number) && text_.substr(0, position).ends_with(token)) return position - token.size();
    std::size_t begin = position > 0 ? position - 1 : 0;
    const auto is_letter = [&](std::size_t offset) { return std::isalpha(static_cast<unsigned char>(text_[offset])) != 0; };
    while (begin > 0 && begin < text_.size() && is_letter(begin) && (is_letter(begin - 1) || text_[begin - 1] == '-')) --begin;
    return begin;
  }

  std::string_view first_word(std::size_t begin) const {
    constexpr std::size_t kLongest = 20;
    const std::string_view rest = text_.substr(begin, kLongest);
    return rest.substr(0, rest.find_first_of(" \t\r\n,"));
  }

  std::string path_of_next() const {
    if (levels_.empty()) return "";
    const Level& level = levels_.back();
    return level.value.is_object() ? join_path(level.path, level.key) : join_path(level.path, level.value.size());
  }

  bool add(Json value) {
    if (levels_.empty()) {
      result_.document = std::move(value);
    } else if (levels_.back().value.is_object()) {
      levels_.back().value[levels_.back().key] = std::move(value);
    } else {
      levels_.back().value.push_back(std::move(value));
    }
    return true;
  }

  bool open(Json value) {
    if (levels_.size() == kDeepest) {
      result_.problems.push_back({file_, path_of_next(), "", "is nested too deeply", "a scene has fewer than 64 levels"});
      return false;
    }
    levels_.push_back({std::move(value), "", {}, path_of_next()});
    return true;
  }

  bool close() {
    Json value = std::move(levels_.back().value);
    levels_.pop_back();
    return add(std::move(value));
  }

  void fail(std::size_t offset, const std::string& value, const std::string& rule, const std::string& remedy) {
    const TextPlace place = place_of(text_, offset);
    const std::string key = "line " + std::to_string(place.line) + ", column " + std::to_string(place.column);
    result_.problems.push_back({file_, key, value, rule, remedy});
  }

  std::string_view text_;
  const std::string& file_;
  JsonText& result_;
  std::vector<Level> levels_;
};

}  // namespace

JsonText parse_json(std::string_view text, const std::string& file) {
  JsonText result;
  DocumentBuilder builder(text, file, result);
  Json::sax_parse(text.begin(), text.end(), &builder);
  return result;
}

std::string shortened(const Json& value) {
  constexpr std::size_t kLongest = 40;
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() <= kLongest) return text;
  std::size_t cut = kLongest - 3;
  while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xC0U) == 0x80U) --cut;  // never within a UTF-8 character
  return text.substr(0, cut) + "...";
}

std::string json_text(const Json& value) { return value.dump(2, ' ', false, Json::error_handler_t::replace); }

std::string join_path(const std::string& path, const std::string& key) { return path.empty() ? key : path + "." + key; }

std::string join_path(const std::string& path, std::size_t index) { return path + "[" + std::to_string(index) + "]"; }

}  // namespace sprung
