#include "output/exporters/sequence_exporter.h"

#include "base/files/file_pattern.h"

#include <utility>

namespace sprung {

SequenceExporter::SequenceExporter(ExportedRun run, std::string ending)
    : run_(std::move(run)), ending_(std::move(ending)), shapes_(shapes_of(run_.model)) {}

std::vector<std::string> SequenceExporter::patterns() const {
  std::vector<std::string> patterns;
  for (const ExportedShape& shape : shapes_) patterns.push_back(pattern_of(shape));
  return patterns;
}

std::vector<ExportedFile> SequenceExporter::frame(const ExportedFrame& frame) {
  std::vector<ExportedFile> files;
  for (const ExportedShape& shape : shapes_) {
    if (!shape.changes && frame.number > 1) continue;
    files.push_back({fill_pattern(pattern_of(shape), frame.number), bytes_of(shape, frame)});
  }
  return files;
}

std::string SequenceExporter::pattern_of(const ExportedShape& shape) const {
  return shape.changes ? sequence_pattern(shape.stem(), run_.frames, ending_) : shape.stem() + ending_;
}

}  // namespace sprung
