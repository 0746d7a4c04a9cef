// Reads its input as a scene file. A scene is refused with a reason, or its resolved text reads again to the same text.
#include "base/error.h"
#include "fuzz/fuzz_file.h"
#include "scene/reading/scene_reader.h"

#include <optional>

namespace sprung::fuzz {
namespace {

std::optional<Scene> read(const std::filesystem::path& file, const std::string& text) {
  write_bytes(file, text.data(), text.size());
  try {
    return read_scene(file);
  } catch (const InputError& error) {
    require(!error.problems().empty(), "what is refused has a reason");
    return std::nullopt;
  }
}

}  // namespace
}  // namespace sprung::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace sprung::fuzz;
  const std::filesystem::path file = own_file("scene.json");
  const auto scene = read(file, std::string(reinterpret_cast<const char*>(bytes), size));
  if (!scene) return 0;
  const auto again = read(file, scene->resolved);
  require(again.has_value(), "the resolved text of an accepted scene is accepted");
  require(again->resolved == scene->resolved, "a resolved scene is resolved to itself");
  return 0;
}
