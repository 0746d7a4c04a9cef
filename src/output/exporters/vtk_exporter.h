// VTK XML, for ParaView: a file for each body and frame, and a list of them with their times.
#pragma once

#include "output/exporters/sequence_exporter.h"

#include <utility>

namespace sprung {

/// PolyData with raw appended arrays: points and, of bodies, the point data velocity [m/s], stretch and contact (see VertexState).
/// Cells are the springs of bodies whose vertices are their particles (else the lines), then the faces. Cell data: `tension` [N] of
/// springs, k_s (|s| - d) plus k_d times the rate of the length, without what a stretch limit carries; 0 of broken springs, faces
/// and lines. `kind`: 0 structural, 1 shear, 2 bend, 3 broken, 4 a face or line.
class VtkExporter final : public SequenceExporter {
 public:
  explicit VtkExporter(ExportedRun run) : SequenceExporter(std::move(run), ".vtp") {}
  [[nodiscard]] std::vector<std::string> patterns() const override;
  [[nodiscard]] std::vector<std::string> losses(bool tears) const override;
  [[nodiscard]] std::vector<ExportedFile> end(int frames) override;

 private:
  [[nodiscard]] std::string bytes_of(const ExportedShape& shape, const ExportedFrame& frame) const override;
};

}  // namespace sprung
