#include "scene/json/json_mistake.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace sprung {
namespace {

struct TextLocation {
  std::size_t line = 1;
  std::size_t column = 1;
};

TextLocation location_of(std::string_view text, std::size_t offset) {
  const std::string_view head = text.substr(0, std::min(offset, text.size()));
  const std::size_t line_begin = head.rfind('\n') == std::string_view::npos ? 0 : head.rfind('\n') + 1;
  return {1 + static_cast<std::size_t>(std::count(head.begin(), head.end(), '\n')), 1 + head.size() - line_begin};
}

std::string_view trimmed_right(std::string_view text) {
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  return last == std::string_view::npos ? std::string_view{} : text.substr(0, last + 1);
}

bool is_non_finite_literal(std::string_view rest) {
  for (const std::string_view word : {"NaN", "nan", "-NaN", "-nan", "Infinity", "-Infinity", "inf", "-inf"}) {
    if (rest.starts_with(word)) return true;
  }
  return false;
}

/// Whether the text begins with a word and a colon.
bool is_bare_key(std::string_view rest) {
  const auto is_in_words = [](unsigned char letter) { return std::isalnum(letter) != 0 || letter == '_'; };
  const auto* const word_end = std::find_if_not(rest.begin(), rest.end(), is_in_words);
  const std::string_view after = rest.substr(static_cast<std::size_t>(word_end - rest.begin()));
  return word_end != rest.begin() && after.find_first_not_of(" \t") == after.find(':') && after.find(':') != std::string_view::npos;
}

/// The most likely mistake at `offset`, the first character that does not fit, and its remedy.
std::pair<std::string, std::string> explain_syntax(std::string_view text, std::size_t offset) {
  if (trimmed_right(text).empty()) return {"is empty", "write a scene, beginning with {"};
  const std::string_view rest = text.substr(std::min(offset, text.size()));
  const std::string_view before = trimmed_right(text.substr(0, std::min(offset, text.size())));
  if (trimmed_right(rest).empty()) return {"ends too early: brackets or quotes are not closed", "is the file complete?"};
  if (rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with("#")) return {"JSON has no comments", "remove it"};
  if (is_non_finite_literal(rest)) return {"is not a JSON number", "write a finite number"};
  if (before.ends_with(',') && (rest.front() == '}' || rest.front() == ']')) {
    return {"nothing follows the comma", "remove the comma before it"};
  }
  for (const auto& [python, json] : {std::pair("True", "true"), {"False", "false"}, {"None", "null"}}) {
    if (rest.starts_with(python)) return {"is not JSON", std::string("write ") + json};
  }
  if (rest.front() == '\'') return {"is not JSON", "put strings and keys in double quotes"};
  if (is_bare_key(rest)) return {"is not JSON", "put keys in double quotes"};
  return {"is not JSON", "check for a missing comma, quote or bracket just before it"};
}

/// The parser's `token` begins at the last string or number, so it counts only if it is one of them as a whole.
std::size_t start_of_mistake(std::string_view text, std::size_t position, const std::string& token) {
  if (position > text.size()) return text.size();
  const bool is_string = token.size() > 1 && token.front() == '"' && token.back() == '"';
  const bool is_number = !token.empty() && token.find_first_not_of("0123456789+-.eE") == std::string::npos;
  if ((is_string || is_number) && text.substr(0, position).ends_with(token)) return position - token.size();
  std::size_t begin = position > 0 ? position - 1 : 0;
  const auto is_letter = [&](std::size_t offset) { return std::isalpha(static_cast<unsigned char>(text[offset])) != 0; };
  while (begin > 0 && begin < text.size() && is_letter(begin) && (is_letter(begin - 1) || text[begin - 1] == '-')) --begin;
  return begin;
}

std::string_view first_word(std::string_view text, std::size_t begin) {
  constexpr std::size_t kLongest = 20;
  const std::string_view rest = text.substr(begin, kLongest);
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n,"));
  return word.size() > 1 && word.ends_with(':') ? word.substr(0, word.size() - 1) : word;
}

Problem problem_at(std::string_view text, std::size_t offset, std::string value, std::string rule, std::string remedy) {
  const TextLocation location = location_of(text, offset);
  return {.key = "line " + std::to_string(location.line) + ", column " + std::to_string(location.column),
          .value = std::move(value),
          .rule = std::move(rule),
          .remedy = std::move(remedy)};
}

}  // namespace

Problem syntax_problem(std::string_view text, std::size_t position, const std::string& token) {
  const std::size_t begin = start_of_mistake(text, position, token);
  auto [rule, remedy] = explain_syntax(text, begin);
  return problem_at(text, begin, std::string(first_word(text, begin)), std::move(rule), std::move(remedy));
}

Problem nul_problem(std::string_view text, std::size_t position) {
  return problem_at(text, position, "", "is a NUL byte, which no text has", "is the file damaged? Save the scene in UTF-8");
}

Problem overflow_problem(std::string_view text, std::size_t position, const std::string& token) {
  const std::size_t end = std::min(position, text.size());
  return problem_at(text, end - std::min(end, token.size()), token, "is too large for a number", "write a number below 1e308");
}

}  // namespace sprung
