#include "viewer/protocol/example_scenes.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <system_error>

namespace sprung {
namespace {

namespace fs = std::filesystem;

/// Whether a file is a scene: a JSON object with bodies.
bool is_scene(const fs::path& file) {
  std::ifstream stream(file);
  const auto json = nlohmann::json::parse(stream, nullptr, false);
  return json.is_object() && json.contains("bodies");
}

std::string first_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// Sentences by the names that stand before them: `**NAME**: sentence`, to the end of the table's cell.
std::map<std::string, std::string> sentences_of(const fs::path& readme) {
  constexpr std::string_view kMark = "**";
  constexpr std::string_view kEnd = "**: ";
  std::map<std::string, std::string> sentences;
  std::ifstream stream(readme);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t begin = line.find(kMark);
    const std::size_t end = begin == std::string::npos ? begin : line.find(kEnd, begin + kMark.size());
    if (end == std::string::npos) continue;
    const std::string name = line.substr(begin + kMark.size(), end - begin - kMark.size());
    std::string sentence = line.substr(end + kEnd.size());
    sentence.erase(std::min(sentence.find(" |"), sentence.size()));
    std::erase(sentence, '`');
    std::erase(sentence, '*');
    sentences[name] = std::move(sentence);
  }
  return sentences;
}

void add_scenes(const fs::path& folder, const std::string& prefix, std::vector<ExampleScene>& scenes) {
  const std::map<std::string, std::string> sentences = sentences_of(folder / "README.md");
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() != ".json" || !entry.is_regular_file(ignored) || !is_scene(entry.path())) continue;
    const std::string stem = entry.path().stem().string();
    ExampleScene scene{.name = prefix + stem, .file = entry.path().string()};
    const auto sentence = sentences.find(stem);
    scene.sentence = sentence != sentences.end() ? sentence->second : first_line(fs::path(entry.path()).replace_extension(".txt"));
    const fs::path picture = folder / "pictures" / (stem + ".png");
    if (fs::is_regular_file(picture, ignored)) scene.picture = picture;
    scenes.push_back(std::move(scene));
  }
}

}  // namespace

std::vector<ExampleScene> scenes_beside(const fs::path& scene) {
  std::vector<ExampleScene> scenes;
  std::error_code ignored;
  const fs::path own = fs::absolute(scene, ignored).parent_path();
  const fs::path folder = own.filename() == "lessons" ? own.parent_path() : own;
  add_scenes(folder, "", scenes);
  add_scenes(folder / "lessons", "lessons/", scenes);
  std::ranges::sort(scenes, {}, &ExampleScene::name);
  return scenes;
}

}  // namespace sprung
