// Runs the program on an example and reads what it wrote.
#pragma once

#include "app/program.h"
#include "base/scratch_folder.h"
#include "base/types.h"
#include "geometry/mesh/polygon_mesh.h"
#include "geometry/mesh/triangle_mesh.h"

#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace sprung::testing {

/// A CSV file by columns. An empty field, such as the distance of what is far from any obstacle, reads as 0.
using Columns = std::map<std::string, std::vector<double>>;

inline Columns read_columns(const std::filesystem::path& file) {
  const auto fields_of = [](const std::string& line) {
    std::vector<std::string> fields(1);
    for (const char letter : line) {
      if (letter == ',') {
        fields.emplace_back();
      } else {
        fields.back() += letter;
      }
    }
    return fields;
  };
  Columns columns;
  std::istringstream lines(read_text(file));
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = fields_of(line);
  while (std::getline(lines, line)) {
    const std::vector<std::string> values = fields_of(line);
    for (std::size_t i = 0; i < names.size(); ++i) columns[names[i]].push_back(std::strtod(values.at(i).c_str(), nullptr));
  }
  return columns;
}

class ExampleRun {
 public:
  /// Runs examples/<name>.json, with more arguments of the command line if need be.
  explicit ExampleRun(const std::string& name, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"run", SPRUNG_SOURCE_DIR "/examples/" + name + ".json", "--quiet", "--out",
                                       output().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ending_ = Program(arguments).wait();
    if (ending_.code == 0) columns_ = read_columns(output() / "diagnostics.csv");
  }

  [[nodiscard]] std::filesystem::path output() const { return scratch_ / "frames"; }
  [[nodiscard]] int exit_code() const { return ending_.code; }
  [[nodiscard]] const std::string& messages() const { return ending_.err; }

  [[nodiscard]] int frames() const { return static_cast<int>(columns_.at("frame").size()); }

  /// A column of diagnostics.csv, an entry a frame.
  [[nodiscard]] const std::vector<double>& column(const std::string& name) const { return columns_.at(name); }

  /// Positions [m] of a body in a frame, counted from 1.
  [[nodiscard]] Points positions(const std::string& body, int frame) const { return read_frame(output() / body, frame).vertices; }

  /// An obstacle that moves, as it was in a frame.
  [[nodiscard]] TriangleMesh obstacle(const std::string& name, int frame) const {
    const PolygonMesh mesh = read_frame(output() / "obstacles" / name, frame);
    return {mesh.vertices, triangulate(mesh.faces)};
  }

 private:
  static PolygonMesh read_frame(const std::filesystem::path& folder, int frame) {
    char number[16];
    std::snprintf(number, sizeof number, "%04d", frame);
    return read_obj(folder / (folder.filename().string() + "." + number + ".obj"));
  }

  ScratchFolder scratch_;
  Ending ending_;
  Columns columns_;
};

}  // namespace sprung::testing
