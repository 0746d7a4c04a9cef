// OBJ, the format of a run's frames.
#pragma once

#include "output/exporters/sequence_exporter.h"

namespace sprung {

/// Bodies that were read from OBJ files are written as these files with other `v` lines; their `mtllib` files and textures are
/// copied with frame 1.
class ObjExporter : public SequenceExporter {
 public:
  explicit ObjExporter(ExportedRun exported);
  [[nodiscard]] std::vector<std::string> patterns() const override;
  [[nodiscard]] std::vector<std::string> losses(bool tears) const override;
  [[nodiscard]] std::vector<ExportedFile> frame(const ExportedFrame& frame) override;

 protected:
  [[nodiscard]] std::string bytes_of(const ExportedShape& shape, const ExportedFrame& frame) const override;

 private:
  /// What does not change in the files of a shape as long as no face tears.
  struct Constant {
    std::string elements;       ///< the lines after the `v` lines, of a shape without a file
    PolygonFaces faces{};       ///< of the body's particles, of a shape whose file has normals
    Triangles triangles{3, 0};  ///< of these faces
  };

  std::vector<Constant> constants_;  ///< of each shape
};

}  // namespace sprung
