// The interface of export formats: a run goes in frame by frame, files come out.
#pragma once

#include "output/record/recorded_model.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace sprung {

/// What stays the same in all frames.
struct ExportedRun {
  RecordedModel model;
  double frame_rate = 30.0;  ///< [1/s]
  int frames = 1;            ///< at most so many will follow: file names have as many digits
};

struct ExportedFrame {
  int number = 1;                          ///< counted from 1
  RecordedFrame state{};                   ///< positions and all else, as in record.bin
  std::vector<std::vector<Index>> torn{};  ///< of each body the numbers of the faces that are gone, ascending
};

struct ExportedFile {
  std::string path;  ///< relative to the folder of the export, with /
  std::string bytes;
  std::filesystem::path copy_of{};  ///< the file that it is a copy of, instead of `bytes`; empty: none
};

/// Makes the files of one format. Knows no disk: whoever calls it writes what it returns. Two exporters that get the same run and
/// the same frames return the same bytes.
class Exporter {
 public:
  virtual ~Exporter() = default;

  /// The names of all files that it may return (see `file_pattern.h`).
  [[nodiscard]] virtual std::vector<std::string> patterns() const = 0;

  /// What the format cannot hold of this run, one line each. `tears`: faces may vanish.
  [[nodiscard]] virtual std::vector<std::string> losses(bool /*tears*/) const { return {}; }

  /// Whether frame() returns all but lists of files, so that a run can write its frames as they come.
  [[nodiscard]] virtual bool writes_each_frame() const = 0;

  /// The files that belong to a frame. Call it for frames 1, 2, 3 ... Throws FileError if a library that makes the bytes fails.
  [[nodiscard]] virtual std::vector<ExportedFile> frame(const ExportedFrame& frame) = 0;

  /// The files that belong to the whole. `frames` is the number of the last frame; where writes_each_frame(), frame() need not have
  /// been called for all of them. Throws as frame().
  [[nodiscard]] virtual std::vector<ExportedFile> end(int frames) = 0;
};

/// The formats of make_exporter(), in the order of the help: obj, ply, pc2, mdd, vtk, gltf, npz, npz64, usda.
[[nodiscard]] const std::vector<std::string>& exporter_formats();

/// The exporter of a format; null for a name that exporter_formats() lacks. It keeps a copy of the run.
[[nodiscard]] std::unique_ptr<Exporter> make_exporter(const std::string& format, ExportedRun run);

}  // namespace sprung
