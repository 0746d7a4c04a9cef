// What formats with a file for each body, obstacle and frame have in common.
#pragma once

#include "output/exporters/exported_shape.h"

namespace sprung {

/// Writes `NAME/NAME.0001` and the ending of each shape that changes, and one file of each other shape with frame 1.
class SequenceExporter : public Exporter {
 public:
  [[nodiscard]] std::vector<std::string> patterns() const override;
  [[nodiscard]] bool writes_each_frame() const override { return true; }
  [[nodiscard]] std::vector<ExportedFile> frame(const ExportedFrame& frame) override;
  [[nodiscard]] std::vector<ExportedFile> end(int /*frames*/) override { return {}; }

 protected:
  /// `ending` has its dot.
  SequenceExporter(ExportedRun run, std::string ending);

  /// The file of a shape, one of shapes(), in a frame.
  [[nodiscard]] virtual std::string bytes_of(const ExportedShape& shape, const ExportedFrame& frame) const = 0;

  [[nodiscard]] std::string pattern_of(const ExportedShape& shape) const;
  [[nodiscard]] const ExportedRun& run() const { return run_; }
  [[nodiscard]] const std::vector<ExportedShape>& shapes() const { return shapes_; }

 private:
  ExportedRun run_;
  std::string ending_;
  std::vector<ExportedShape> shapes_;
};

}  // namespace sprung
