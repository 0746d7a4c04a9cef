// JSON text to a document, strictly: no comments, no duplicate keys, no numbers beyond double. Reports the location of each
// mistake.
#pragma once

#include "base/error.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace sprung {

/// Keeps keys in the order of the file.
using Json = nlohmann::ordered_json;

/// The document of a text and all its problems. The `key` of a syntax problem is `line 3, column 7`, that of a duplicate key its
/// path. The document is usable only without problems.
struct JsonText {
  Json document;
  std::vector<Problem> problems;
};
[[nodiscard]] JsonText parse_json(std::string_view text, const std::string& file);

/// A value as the user would write it, shortened to about 40 characters.
[[nodiscard]] std::string shortened(const Json& value);

/// JSON text with an indent of two spaces; invalid UTF-8 is replaced.
[[nodiscard]] std::string json_text(const Json& value);

/// `key` within `path`: `bodies.banner`. The path of the whole document is empty.
[[nodiscard]] std::string join_path(const std::string& path, const std::string& key);

/// Entry `index` of the array at `path`: `pins[0]`.
[[nodiscard]] std::string join_path(const std::string& path, std::size_t index);

}  // namespace sprung
