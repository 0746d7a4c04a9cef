// One body or obstacle as OBJ text, frame after frame. What does not change between frames is formatted once.
#pragma once

#include "simulation/simulator.h"

#include <functional>
#include <string>
#include <vector>

namespace sprung {

class ObjSequence {
 public:
  /// `pattern` names the files, relative to the run's folder (see `file_pattern.h`); without `#` there is one file, for the first
  /// frame. `vertices` gives the positions [m] at the simulator's present time. Vertex i is the i-th `v` line.
  ObjSequence(std::string pattern, std::function<Points(const Simulator&)> vertices, const PolygonFaces& faces, const Edges& lines);

  [[nodiscard]] const std::string& pattern() const { return pattern_; }
  [[nodiscard]] bool changes() const;
  [[nodiscard]] std::string text(const Simulator& simulator) const;

 private:
  std::string pattern_;
  std::function<Points(const Simulator&)> vertices_;
  std::string elements_;  // the `vt`, `g`, `f` and `l` lines
};

/// `v` lines, with the shortest numbers that read back equal. Same text for any number of threads.
[[nodiscard]] std::string vertex_lines(const Points& vertices);

/// The sequences of all bodies, then of all obstacles. Throws InputError for names that cannot be folders: other than letters,
/// digits,
/// `_` and `-`, used twice, or a body called `obstacles`.
[[nodiscard]] std::vector<ObjSequence> obj_sequences(const Simulator& simulator, int frames);

}  // namespace sprung
