#include "output/exporters/point_cache_exporter.h"

#include "output/exporters/binary_text.h"

#include <algorithm>

namespace sprung {
namespace {

constexpr std::size_t kBytesPerPoint = 3 * sizeof(float);

}  // namespace

PointCacheExporter::PointCacheExporter(ExportedRun run, Format format)
    : run_(std::move(run)), format_(format), shapes_(shapes_of(run_.model)), samples_(shapes_.size()) {}

std::vector<std::string> PointCacheExporter::patterns() const {
  std::vector<std::string> patterns;
  for (const ExportedShape& shape : shapes_) {
    if (!shape.changes) continue;
    patterns.push_back(shape.folder + shape.name + ".obj");
    patterns.push_back(shape.folder + shape.name + ending());
  }
  return patterns;
}

std::vector<std::string> PointCacheExporter::losses(bool tears) const {
  std::string torn = "faces that tear stay in ";
  std::string plain = "no materials of faces are in the OBJ files of ";
  for (std::string* loss : {&torn, &plain}) loss->append(ending()).append(" files");
  std::vector<std::string> losses;
  if (tears) losses.push_back(torn);
  if (has_materials(run_.model)) losses.push_back(plain);
  return losses;
}

std::vector<ExportedFile> PointCacheExporter::frame(const ExportedFrame& frame) {
  const std::endian order = format_ == Format::pc2 ? std::endian::little : std::endian::big;
  std::vector<ExportedFile> files;
  times_.push_back(frame.state.time);
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    const ExportedShape& shape = shapes_[k];
    if (!shape.changes) continue;
    const Points vertices = vertices_of(run_.model, shape, frame.state);
    if (frame.number == 1) files.push_back({shape.folder + shape.name + ".obj", obj_text(vertices, shape.faces, shape.lines)});
    append_points<float>(samples_[k], vertices, order);
  }
  return files;
}

std::vector<ExportedFile> PointCacheExporter::end(int /*frames*/) {
  std::vector<ExportedFile> files;
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    if (!shapes_[k].changes) continue;
    const std::size_t points = samples_[k].size() / (kBytesPerPoint * std::max<std::size_t>(times_.size(), 1));
    files.push_back({shapes_[k].folder + shapes_[k].name + ending(), head(points) + samples_[k]});
  }
  return files;
}

std::string PointCacheExporter::head(std::size_t points) const {
  const auto count = static_cast<std::int32_t>(points);
  const auto samples = static_cast<std::int32_t>(times_.size());
  std::string bytes;
  if (format_ == Format::pc2) {
    bytes.assign("POINTCACHE2\0", 12);
    append_little(bytes, std::int32_t{1});
    append_little(bytes, count);
    append_little(bytes, 0.0F);
    append_little(bytes, 1.0F);
    append_little(bytes, samples);
    return bytes;
  }
  append_bytes(bytes, samples, std::endian::big);
  append_bytes(bytes, count, std::endian::big);
  for (const double time : times_) append_bytes(bytes, static_cast<float>(time), std::endian::big);
  return bytes;
}

}  // namespace sprung
