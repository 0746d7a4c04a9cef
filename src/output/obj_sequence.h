// The OBJ files of one body or obstacle. Lines that do not change between frames are formatted once.
#pragma once

#include "simulation/simulator.h"

#include <functional>
#include <string>
#include <vector>

namespace sprung {

/// OBJ text of a body or an obstacle for each frame.
class ObjSequence {
 public:
  /// `pattern` names the files relative to the run's folder (see `file_pattern.h`). A pattern without `#` names one file, of the
  /// first frame. `vertices` returns the positions [m], 3 x n, at the simulator's present time; column i is the i-th `v` line.
  ObjSequence(std::string pattern, std::function<Points(const Simulator&)> vertices, const PolygonFaces& faces, const Edges& lines);

  [[nodiscard]] const std::string& pattern() const { return pattern_; }

  /// Whether there is a file for each frame.
  [[nodiscard]] bool changes() const;

  /// The file at the simulator's present time.
  [[nodiscard]] std::string text(const Simulator& simulator) const;

 private:
  std::string pattern_;
  std::function<Points(const Simulator&)> vertices_;
  std::string elements_;  ///< the `vt`, `g`, `f` and `l` lines
};

/// The `v` lines of positions [m], 3 x n, with the shortest numbers that read back to the same bits. The text does not depend on
/// the number of threads.
[[nodiscard]] std::string vertex_lines(const Points& vertices);

/// The positions of the `v` lines of a text that vertex_lines() made, 3 x n. Lines that are no `v` lines, or hold no three numbers,
/// are left out.
[[nodiscard]] Points read_vertex_lines(const std::string& text);

/// The sequences of all bodies, then of all obstacles. Throws InputError for names that are not valid folder names: a name with
/// characters other than letters, digits, `_` and `-`, a name that is used twice, or a body with the name `obstacles`.
[[nodiscard]] std::vector<ObjSequence> obj_sequences(const Simulator& simulator, int frames);

}  // namespace sprung
