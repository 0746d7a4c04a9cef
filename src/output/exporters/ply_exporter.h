// PLY, Stanford's polygon format, binary and little-endian: a file for each body and frame.
#pragma once

#include "output/exporters/sequence_exporter.h"

#include <utility>

namespace sprung {

/// Vertices have x, y, z [m], those of bodies vx, vy, vz [m/s], stretch and contact too (see VertexState), all float but contact.
/// Faces have `vertex_indices` and, with UVs, `texcoord`: u and v of each corner. Lines are `edge` elements.
class PlyExporter final : public SequenceExporter {
 public:
  explicit PlyExporter(ExportedRun run) : SequenceExporter(std::move(run), ".ply") {}
  [[nodiscard]] std::vector<std::string> losses(bool tears) const override;

 private:
  [[nodiscard]] std::string bytes_of(const ExportedShape& shape, const ExportedFrame& frame) const override;
};

}  // namespace sprung
