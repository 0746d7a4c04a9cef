// OBJ from a record: a file for each body and frame.
#pragma once

#include "output/exporters/exported_shape.h"

namespace sprung {

/// What a run writes by itself (`ObjSequence`), made from what the record knows: bodies that were read from OBJ files lose their
/// comments, materials and normals.
class ObjExporter final : public Exporter {
 public:
  explicit ObjExporter(ExportedRun run);
  [[nodiscard]] std::vector<std::string> patterns() const override;
  [[nodiscard]] std::vector<std::string> losses(bool tears) const override;
  [[nodiscard]] bool writes_each_frame() const override { return true; }
  [[nodiscard]] std::vector<ExportedFile> frame(const ExportedFrame& frame) override;
  [[nodiscard]] std::vector<ExportedFile> end(int /*frames*/) override { return {}; }

 private:
  ExportedRun run_;
  std::vector<ExportedShape> shapes_;
};

}  // namespace sprung
