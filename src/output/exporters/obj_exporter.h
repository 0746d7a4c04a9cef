// OBJ from a record: a file for each body and frame.
#pragma once

#include "output/exporters/sequence_exporter.h"

#include <utility>

namespace sprung {

/// What a run writes by itself (`ObjSequence`), made from what the record knows: bodies that were read from OBJ files lose their
/// comments, materials and normals.
class ObjExporter final : public SequenceExporter {
 public:
  explicit ObjExporter(ExportedRun run) : SequenceExporter(std::move(run), ".obj") {}
  [[nodiscard]] std::vector<std::string> losses(bool tears) const override;

 private:
  [[nodiscard]] std::string bytes_of(const ExportedShape& shape, const ExportedFrame& frame) const override;
};

}  // namespace sprung
