// What the user asked for.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace sprung {

/// A scene file, and what is said about it on the command line.
struct SceneOptions {
  std::string file;
  std::vector<std::string> overrides;   ///< `key.path=json`
  std::vector<std::string> mesh_paths;  ///< folders
};

struct RunOptions {
  SceneOptions scene;
  std::string out;
  std::optional<int> frames;
  std::optional<int> threads;
  bool quiet = false;
  bool overwrite = false;
};

struct ValidateOptions {
  SceneOptions scene;
};

struct InfoOptions {
  std::vector<std::string> meshes;  ///< one, or the frames of a sequence
};

/// Help or version: to be printed, and that is all.
struct PrintOptions {
  std::string text;
};

using Command = std::variant<RunOptions, ValidateOptions, InfoOptions, PrintOptions>;

/// A command line that makes no sense; one problem a line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws UsageError.
[[nodiscard]] Command parse_command_line(int argc, const char* const* argv);

}  // namespace sprung
