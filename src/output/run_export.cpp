#include "output/run_export.h"

#include <algorithm>

namespace sprung {

ExportedRun exported_run(const RecordedRun& run) {
  return {.model = run.model(), .frame_rate = run.frame_rate(), .frames = run.frames()};
}

void export_frames(const RecordedRun& run, Exporter& exporter, const std::function<void(const ExportedFile&)>& write) {
  for (int number = 1; number <= run.frames(); ++number) {
    const ExportedFrame frame{.number = number, .state = run.frame(number), .torn = torn_in(run.model(), run.torn_faces(), number)};
    std::ranges::for_each(exporter.frame(frame), write);
  }
  std::ranges::for_each(exporter.end(run.frames()), write);
}

std::string content_of(const ExportedFile& file) {
  return file.copy_of.empty() ? file.bytes : content_of(MaterialFile{.source = file.copy_of, .place = file.path});
}

std::vector<std::vector<Index>> torn_in(const RecordedModel& model, const std::vector<TornFaces>& torn_faces, int frame) {
  std::vector<std::vector<Index>> torn(model.bodies.size());
  for (const TornFaces& faces : torn_faces) {
    const auto body = std::ranges::find(model.bodies, faces.body, &RecordedBody::name);
    if (faces.frame > frame || body == model.bodies.end()) continue;
    std::vector<Index>& all = torn[static_cast<std::size_t>(body - model.bodies.begin())];
    all.insert(all.end(), faces.faces.begin(), faces.faces.end());
  }
  for (std::vector<Index>& faces : torn) std::ranges::sort(faces);
  return torn;
}

}  // namespace sprung
