#include "scene/json/overrides.h"

#include "scene/json/nearest_name.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

namespace sprung {
namespace {

using PathElement = std::variant<std::string, std::size_t>;

constexpr std::size_t kMostElements = 64;  // no scene is deeper

constexpr const char* kForm = "write key.path=value, for example bodies.rope.pins[0].nearest=[0,1,0]";

std::optional<std::size_t> index_in_brackets(std::string_view text) {
  std::size_t index = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), index);
  if (text.empty() || end.ec != std::errc{} || end.ptr != text.data() + text.size()) return std::nullopt;
  return index;
}

/// Splits `pins[0][1]` into `pins`, 0, 1.
bool append_elements(std::string_view text, std::vector<PathElement>& elements) {
  const std::size_t name_end = std::min(text.find('['), text.size());
  if (name_end == 0) return false;
  elements.emplace_back(std::string(text.substr(0, name_end)));
  for (text.remove_prefix(name_end); !text.empty();) {
    const std::size_t close = text.find(']');
    if (text.front() != '[' || close == std::string_view::npos) return false;
    const auto index = index_in_brackets(text.substr(1, close - 1));
    if (!index) return false;
    elements.emplace_back(*index);
    text.remove_prefix(close + 1);
  }
  return true;
}

std::optional<std::vector<PathElement>> split_path(std::string_view path) {
  std::vector<PathElement> elements;
  while (true) {
    const std::size_t dot = path.find('.');
    if (!append_elements(path.substr(0, dot), elements) || elements.size() > kMostElements) return std::nullopt;
    if (dot == std::string_view::npos) return elements;
    path.remove_prefix(dot + 1);
  }
}

bool is_bare_word(std::string_view text) {
  const auto allowed = [](unsigned char letter) {
    return letter > ' ' && std::string_view("{}[]\",:'").find(static_cast<char>(letter)) == std::string_view::npos;
  };
  return !text.empty() && std::all_of(text.begin(), text.end(), allowed);
}

/// Accepts number formats that JSON does not: .5, 1., +2, 007.
std::optional<double> read_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0.0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
  if (end.ec != std::errc{} || end.ptr != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::optional<Json> read_value(const std::string& text) {
  JsonText json = parse_json(text, "");
  if (json.problems.empty()) return std::move(json.document);
  if (const auto number = read_number(text)) return Json(*number);
  if (is_bare_word(text)) return Json(text);
  return std::nullopt;
}

/// The value at `element` of `json`. A null `json` becomes an object or a list. Returns null and sets `problem` if `json` has no
/// such element.
Json* descend(Json& json, const PathElement& element, std::string& problem) {
  if (const auto* name = std::get_if<std::string>(&element)) {
    if (json.is_null()) json = Json::object();
    if (json.is_object()) return &json[*name];
    problem = "has no keys: it is not an object";
    return nullptr;
  }
  const std::size_t index = std::get<std::size_t>(element);
  if (json.is_null() && index > 0) {
    problem = "is not written in the scene, so it has no entry " + std::to_string(index) + ": set the whole list";
    return nullptr;
  }
  if (json.is_null()) json = Json::array();
  if (!json.is_array()) {
    problem = "has no entries: it is not a list";
    return nullptr;
  }
  if (index > json.size()) {
    problem = "has " + std::to_string(json.size()) + (json.size() == 1 ? " entry" : " entries") + ", so there is no entry " +
              std::to_string(index);
    return nullptr;
  }
  if (index == json.size()) json.push_back(nullptr);
  return &json[index];
}

std::string join_element(const std::string& path, const PathElement& element) {
  return std::visit([&](const auto& value) { return join_path(path, value); }, element);
}

/// Sets the value, or returns the problem and leaves the document unchanged.
std::string assign(Json& document, const std::vector<PathElement>& elements, Json value) {
  Json changed = document;
  Json* at = &changed;
  Json* parent = nullptr;
  std::string path;
  for (const PathElement& element : elements) {
    std::string problem;
    parent = at;
    at = descend(*parent, element, problem);
    if (at == nullptr) return (path.empty() ? "the scene" : path) + " " + problem;
    path = join_element(path, element);
  }
  const auto* name = std::get_if<std::string>(&elements.back());
  if (value.is_null() && name != nullptr) {
    parent->erase(*name);
  } else {
    *at = std::move(value);
  }
  document = std::move(changed);
  return "";
}

/// A remedy if the path leads into a body or an obstacle that does not exist, unless it sets the shape of a new one.
std::optional<std::string> missing_entry(const Json& document, const std::vector<PathElement>& elements) {
  if (elements.size() < 3 || elements[2] == PathElement("shape")) return std::nullopt;
  const auto* group = std::get_if<std::string>(&elements[0]);
  const auto* name = std::get_if<std::string>(&elements[1]);
  if (group == nullptr || name == nullptr || (*group != "bodies" && *group != "obstacles")) return std::nullopt;
  const auto entries = document.find(*group);
  if (entries == document.end() || !entries->is_object() || entries->contains(*name)) return std::nullopt;
  std::vector<std::string> names;
  for (const auto& entry : entries->items()) names.push_back(entry.key());
  if (const auto near = nearest_name(*name, names)) return "did you mean \"" + *near + "\"?";
  return (names.empty() ? "" : "choose from " + joined(names) + ", or ") + "set its shape first, to add it";
}

/// The text, cut where it is too long for a message.
std::string beginning_of(const std::string& text) {
  constexpr std::size_t kLongest = 200;
  if (text.size() <= kLongest) return text;
  std::size_t cut = kLongest;
  while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xC0U) == 0x80U) --cut;  // not inside a UTF-8 character
  return text.substr(0, cut) + "...";
}

}  // namespace

void apply_override(const std::string& override_text, Json& document, std::vector<Problem>& problems) {
  const auto report = [&](const std::string& rule, const std::string& remedy) {
    problems.push_back({"", "--set", beginning_of(override_text), rule, remedy});
  };
  const std::size_t equals = override_text.find('=');
  const auto elements = equals == std::string::npos ? std::nullopt : split_path(std::string_view(override_text).substr(0, equals));
  if (!elements) return report("is not of the form key.path=value", kForm);
  auto value = read_value(override_text.substr(equals + 1));
  if (!value) return report("the value after = is neither JSON nor a single word", kForm);
  if (const auto remedy = missing_entry(document, *elements)) return report("the scene has no entry of that name", *remedy);
  const std::string problem = assign(document, *elements, std::move(*value));
  if (!problem.empty()) report(problem, "check the path");
}

}  // namespace sprung
