#include "scene/reading/scene_reader.h"

#include "base/files/text_encoding.h"
#include "scene/json/near_file.h"
#include "scene/json/overrides.h"
#include "scene/reading/scene_rules.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace sprung {
namespace {

void throw_if_any(std::vector<Problem> problems) {
  if (!problems.empty()) throw InputError(std::move(problems));
}

/// Whether the key is the path or below it.
bool is_within(const std::string& key, const std::string& path) {
  return key.starts_with(path) && (key.size() == path.size() || key[path.size()] == '.' || key[path.size()] == '[');
}

/// Marks problems at an overridden key, below it, or at an object around it.
void mark_overridden(const std::vector<std::string>& overrides, std::vector<Problem>& problems) {
  for (Problem& problem : problems) {
    const bool overridden = std::ranges::any_of(overrides, [&](const std::string& text) {
      const std::string path = text.substr(0, text.find('='));
      return is_within(problem.key, path) || is_within(path, problem.key);
    });
    if (overridden) problem.file += ", changed by --set";
  }
}

[[noreturn]] void fail_to_read(const std::filesystem::path& file, int error) {
  std::string reason = std::generic_category().message(error);
  const auto near = error == ENOENT ? near_file({""}, file, ".json") : std::nullopt;
  if (near) reason += "; did you mean \"" + *near + "\"?";
  throw FileError("read", file.string(), reason);
}

std::ifstream open_scene_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) fail_to_read(file, EISDIR);
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail_to_read(file, errno != 0 ? errno : EIO);
  return stream;
}

}  // namespace

void check_scene_file(const std::filesystem::path& file) { (void)open_scene_file(file); }

std::string read_scene_file(const std::filesystem::path& file) {
  std::ifstream stream = open_scene_file(file);
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (stream.bad()) fail_to_read(file, EIO);
  return utf8_text(std::move(text));
}

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  TextProblems problems;
  Scene scene = read_scene_text(read_scene_file(file), file, overrides, problems);
  throw_if_any(std::move(problems.all));
  return scene;
}

Scene read_scene_text(const std::string& text, const std::filesystem::path& file, const std::vector<std::string>& overrides,
                      TextProblems& problems) {
  JsonText json = parse_json(text, file.string());
  throw_if_any(std::move(json.problems));
  std::vector<Problem> found;
  for (const std::string& change : overrides) apply_override(change, json.document, found);

  std::size_t unknown = 0;
  auto scene = scene_rule()(json.document, {file.string(), "", &found, &unknown});
  mark_overridden(overrides, found);
  if (!scene) throw InputError(std::move(found));
  problems.only_unknown_keys = found.size() == unknown;
  problems.all = std::move(found);
  scene->file = file;
  scene->resolved = json_text(json.document);
  return std::move(*scene);
}

}  // namespace sprung
