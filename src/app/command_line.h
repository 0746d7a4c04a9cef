// Parses the command line.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace sprung {

/// A scene file and its options.
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

/// The text of --help or --version, to print.
struct PrintOptions {
  std::string text;
};

using Command = std::variant<RunOptions, ValidateOptions, InfoOptions, PrintOptions>;

/// An invalid command line; one problem per line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws UsageError.
[[nodiscard]] Command parse_command_line(int argc, const char* const* argv);

}  // namespace sprung
