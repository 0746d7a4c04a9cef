// The OBJ files of one body or obstacle. Lines that do not change between frames are formatted once.
#pragma once

#include "geometry/obj_source/obj_source.h"

#include <functional>
#include <string>
#include <vector>

namespace sprung {

struct Body;
class Simulator;

/// OBJ text of a body or an obstacle for each frame. Const members may be called from several threads at the same time, but not
/// during a step of the simulator. text() is costly: it formats all vertices, in parallel.
class ObjSequence {
 public:
  /// `pattern` names the files relative to the run's folder (see `file_pattern.h`). A pattern without `#` names one file, of the
  /// first frame. `text` returns the file at the simulator's present time.
  ObjSequence(std::string pattern, std::function<std::string(const Simulator&)> text);

  [[nodiscard]] const std::string& pattern() const { return pattern_; }

  /// Whether there is a file for each frame.
  [[nodiscard]] bool changes() const;

  /// The file at the simulator's present time.
  [[nodiscard]] std::string text(const Simulator& simulator) const { return text_(simulator); }

 private:
  std::string pattern_;
  std::function<std::string(const Simulator&)> text_;
};

/// A file that is written with the first frame.
struct CopiedFile {
  std::string path;  ///< relative to the run's folder
  MaterialFile file;
};

/// The `v` lines of positions [m], 3 x n, with the shortest numbers that read back to the same bits. The text does not depend on
/// the number of threads.
[[nodiscard]] std::string vertex_lines(const Points& vertices);

/// The positions of the `v` lines of a frame, 3 x n. Lines that are no `v` lines, or hold no three numbers, are left out.
[[nodiscard]] Points read_vertex_lines(const std::string& text);

/// The body's OBJ text at the simulator's present time: its source with new `v` lines. Without a source (null), its surface.
[[nodiscard]] std::string body_obj_text(const Simulator& simulator, const Body& body, const ObjSource* source);

/// Throws InputError for names of bodies and obstacles that are not valid folder names: a name with characters other than letters,
/// digits, `_` and `-`, a name that is used twice, or a body with the name `obstacles`.
void check_output_names(const Simulator& simulator);

/// The sequences of all bodies, then of all obstacles. Requires names that check_output_names() accepts.
[[nodiscard]] std::vector<ObjSequence> obj_sequences(const Simulator& simulator, const ObjSources& sources, int frames);

/// The materials of all bodies, in the folders of their frames.
[[nodiscard]] std::vector<CopiedFile> copied_files(const ObjSources& sources);

}  // namespace sprung
