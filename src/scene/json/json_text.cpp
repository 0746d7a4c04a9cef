#include "scene/json/json_text.h"

#include "base/files/text_encoding.h"
#include "scene/json/json_mistake.h"

#include <cstddef>
#include <set>
#include <utility>

namespace sprung {
namespace {

constexpr std::size_t kDeepest = 64;  // no scene is deeper, and recursive readers must not exhaust the stack

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
    result_.problems.push_back(error.id == kNumberOverflow ? overflow_problem(text_, position, token)
                                                           : syntax_problem(text_, position, token));
    result_.problems.back().file = file_;
    return false;
  }

 private:
  struct Level {
    Json value;
    std::string key;
    std::set<std::string> keys;
    std::string path;
  };

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

  std::string_view text_;
  const std::string& file_;
  JsonText& result_;
  std::vector<Level> levels_;
};

}  // namespace

JsonText parse_json(std::string_view text, const std::string& file) {
  JsonText result;
  if (is_utf32(text)) {
    result.problems.push_back({file, "", "", "is text in UTF-32", "save it in UTF-8"});
    return result;
  }
  // The parser takes this byte for the end of the text.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    result.problems.push_back(nul_problem(text, nul));
    result.problems.back().file = file;
    return result;
  }
  DocumentBuilder builder(text, file, result);
  Json::sax_parse(text.begin(), text.end(), &builder);
  return result;
}

std::string shortened(const Json& value) {
  constexpr std::size_t kLongest = 40;
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() <= kLongest) return text;
  std::size_t cut = kLongest - 3;
  while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xC0U) == 0x80U) --cut;  // not inside a UTF-8 character
  return text.substr(0, cut) + "...";
}

std::string json_text(const Json& value) { return value.dump(2, ' ', false, Json::error_handler_t::replace); }

std::string join_path(const std::string& path, const std::string& key) { return path.empty() ? key : path + "." + key; }

std::string join_path(const std::string& path, std::size_t index) { return path + "[" + std::to_string(index) + "]"; }

}  // namespace sprung
