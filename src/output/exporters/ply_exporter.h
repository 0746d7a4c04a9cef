// PLY, Stanford's polygon format, binary and little-endian: a file for each body and frame.
#pragma once

#include "output/exporters/exported_shape.h"

namespace sprung {

/// Vertices have x, y, z [m], those of bodies vx, vy, vz [m/s], stretch and contact too (see VertexState), all float but contact.
/// Faces have `vertex_indices` and, with UVs, `texcoord`: u and v of each corner. Lines are `edge` elements.
class PlyExporter final : public Exporter {
 public:
  explicit PlyExporter(ExportedRun run);
  [[nodiscard]] std::vector<std::string> patterns() const override;
  [[nodiscard]] std::vector<std::string> losses(bool tears) const override;
  [[nodiscard]] bool writes_each_frame() const override { return true; }
  [[nodiscard]] std::vector<ExportedFile> frame(const ExportedFrame& frame) override;
  [[nodiscard]] std::vector<ExportedFile> end(int /*frames*/) override { return {}; }

 private:
  [[nodiscard]] std::string text(const ExportedShape& shape, const ExportedFrame& frame) const;

  ExportedRun run_;
  std::vector<ExportedShape> shapes_;
};

}  // namespace sprung
