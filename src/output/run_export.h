// Exports a run that was recorded.
#pragma once

#include "output/exporters/exporter.h"
#include "output/recorded_run.h"

#include <functional>

namespace sprung {

/// What an exporter begins with. Frames have as many digits as the number of frames that can be read.
[[nodiscard]] ExportedRun exported_run(const RecordedRun& run);

/// Reads all frames of the run, one after the other, and gives the exporter's files to `write`. Throws as RecordedRun::frame(), and
/// what `write` throws.
void export_frames(const RecordedRun& run, Exporter& exporter, const std::function<void(const ExportedFile&)>& write);

/// The bytes of a file. Throws FileError if the file that it is a copy of cannot be read.
[[nodiscard]] std::string content_of(const ExportedFile& file);

/// The faces of each body of the model that are gone in a frame.
[[nodiscard]] std::vector<std::vector<Index>> torn_in(const RecordedModel& model, const std::vector<TornFaces>& torn_faces,
                                                      int frame);

}  // namespace sprung
