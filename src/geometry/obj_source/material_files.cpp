#include "geometry/obj_source/material_files.h"

#include "base/error.h"
#include "base/files/text_encoding.h"
#include "base/format.h"
#include "geometry/import/text_words.h"
#include "geometry/obj_source/obj_lines.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

namespace sprung {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> kTextureKeys{"bump", "disp", "decal", "refl", "norm"};
constexpr std::string_view kAntialiasing = "map_aat";  // on or off, no file

bool names_texture(std::string_view word) {
  const std::string key = lower_case(std::string(word));
  return (key.starts_with("map_") && key != kAntialiasing) || std::ranges::find(kTextureKeys, key) != kTextureKeys.end();
}

/// The number of the word with which the texture's name begins, after options such as `-s 2 2 1`.
std::size_t name_word(std::string_view text, const ObjLine& line) {
  std::size_t word = 1;
  while (word < line.words.size() && line.word(text, word).starts_with('-')) {
    const std::string option = lower_case(std::string(line.word(text, word++)));
    const bool vector = option == "-o" || option == "-s" || option == "-t";
    const std::size_t most = vector ? 3 : (option == "-mm" ? 2 : 1);
    for (std::size_t value = 0; value < most && word < line.words.size(); ++value, ++word) {
      if (vector && !parse_number<double>(line.word(text, word))) break;
    }
  }
  return word;
}

fs::path with_slashes(std::string_view name) {
  std::string path(name);
  std::replace(path.begin(), path.end(), '\\', '/');
  return fs::path(path);
}

bool leads_out(const fs::path& path) {
  const bool has_drive = path.string().find(':') == 1;
  return path.is_absolute() || has_drive || std::ranges::find(path, fs::path("..")) != path.end();
}

/// Empty if the name has no place: frames are `.obj` files, and `#` stands for the digits of their numbers.
std::string place_of(std::string_view name) {
  const fs::path path = with_slashes(name);
  const fs::path place = leads_out(path) ? path.filename() : path.lexically_normal();
  const bool usual = place.has_filename() && place != "." && lower_case(place.extension().string()) != ".obj" &&
                     place.string().find('#') == std::string::npos;
  return usual ? place.string() : "";
}

std::optional<fs::path> find_file(const fs::path& folder, std::string_view name) {
  std::error_code ignored;
  for (const fs::path& path : {fs::path(name), with_slashes(name), with_slashes(name).filename()}) {
    if (fs::is_regular_file(folder / path, ignored)) return folder / path;
  }
  return std::nullopt;
}

std::string read_text(const fs::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return utf8_text(std::move(bytes).str());
}

class Finder {
 public:
  void read_obj(const fs::path& file, std::string_view text) {
    ObjLine line;
    for (std::size_t at = 0; at < text.size(); at = line.whole.end) {
      read_obj_line(text, at, line);
      if (line.word(text, 0) != "mtllib" || line.words.size() < 2) continue;
      for (const std::string_view name : library_names(file.parent_path(), text, line)) add_library(file.parent_path(), name);
    }
  }

  MaterialFiles take() { return std::move(found_); }

 private:
  /// All words are one name if there is such a file, or if there is none of a single word.
  static std::vector<std::string_view> library_names(const fs::path& folder, std::string_view text, const ObjLine& line) {
    const std::string_view all = TextRange{line.words[1].begin, line.words.back().end}.of(text);
    std::vector<std::string_view> names;
    for (std::size_t word = 1; word < line.words.size(); ++word) names.push_back(line.word(text, word));
    const auto exists = [&](std::string_view name) { return find_file(folder, name).has_value(); };
    std::error_code ignored;
    if (fs::is_regular_file(folder / with_slashes(all), ignored) || std::ranges::none_of(names, exists)) return {all};
    return names;
  }

  void add_library(const fs::path& folder, std::string_view name) {
    const auto file = find_file(folder, name);
    const std::string place = file ? place_of(name) : "";
    if (!add(file, name, place)) return;
    if (leads_out(with_slashes(name))) found_.outside.emplace_back(name);
    const std::size_t index = found_.files.size() - 1;
    if (auto text = copy_of_library(*file, fs::path(place).parent_path())) found_.files[index].text = std::move(text);
  }

  /// Adds the textures of an MTL file that is placed in `folder`, and returns its text if it names them by other names.
  std::optional<std::string> copy_of_library(const fs::path& file, const fs::path& folder) {
    const std::string text = read_text(file);
    std::string copy;
    std::size_t copied = 0;
    ObjLine line;
    for (std::size_t at = 0; at < text.size(); at = line.whole.end) {
      read_obj_line(text, at, line);
      if (!names_texture(line.word(text, 0))) continue;
      const std::size_t first = name_word(text, line);
      if (first >= line.words.size()) continue;
      const TextRange range{line.words[first].begin, line.words.back().end};
      const std::string_view name = range.of(text);
      const auto texture = find_file(file.parent_path(), name);
      const std::string place = texture ? place_of(name) : "";
      if (add(texture, name, place.empty() ? "" : (folder / place).string())) found_.files.back().is_texture = true;
      if (place.empty() || place == name) continue;
      copy.append(text, copied, range.begin - copied) += place;
      copied = range.end;
    }
    if (copied == 0) return std::nullopt;
    return copy.append(text, copied);
  }

  /// Whether the file was added and was not before.
  bool add(const std::optional<fs::path>& file, std::string_view name, const std::string& place) {
    const auto keep = [&](std::vector<std::string>& names) {
      if (std::ranges::find(names, name) == names.end()) names.emplace_back(name);
      return false;
    };
    if (!file) return keep(found_.missing);
    if (place.empty()) return keep(found_.unusual);
    const auto same_place = std::ranges::find(found_.files, place, &MaterialFile::place);
    if (same_place != found_.files.end()) {
      std::error_code ignored;
      return fs::equivalent(same_place->source, *file, ignored) ? false : keep(found_.unusual);
    }
    found_.files.push_back({.source = *file, .place = place});
    return true;
  }

  MaterialFiles found_;
};

}  // namespace

MaterialFiles find_material_files(const fs::path& obj_file, std::string_view obj_text) {
  Finder finder;
  finder.read_obj(obj_file, obj_text);
  return finder.take();
}

std::map<std::string, std::array<double, 3>> diffuse_colours(const MaterialFiles& materials) {
  std::map<std::string, std::array<double, 3>> colours;
  for (const MaterialFile& file : materials.files) {
    if (file.is_texture) continue;
    const std::string text = utf8_text(content_of(file));
    std::string name;
    ObjLine line;
    for (std::size_t at = 0; at < text.size(); at = line.whole.end) {
      read_obj_line(text, at, line);
      if (line.word(text, 0) == "newmtl" && line.words.size() > 1) {
        name = TextRange{line.words[1].begin, line.words.back().end}.of(text);
      }
      if (line.word(text, 0) != "Kd") continue;
      std::array<std::optional<double>, 3> read;
      for (std::size_t k = 0; k < read.size(); ++k) read[k] = parse_number<double>(line.word(text, k + 1));
      if (read[0] && read[1] && read[2]) colours.try_emplace(name, std::array{*read[0], *read[1], *read[2]});
    }
  }
  return colours;
}

std::string content_of(const MaterialFile& file) {
  if (file.text) return *file.text;
  errno = 0;
  std::ifstream stream(file.source, std::ios::binary);
  std::ostringstream bytes;
  if (stream.peek() != std::ifstream::traits_type::eof()) bytes << stream.rdbuf();
  if (!stream.is_open() || stream.bad()) throw FileError("copy", file.source.string(), std::strerror(errno));
  return std::move(bytes).str();
}

}  // namespace sprung
