#include "output/exporters/npz_exporter.h"

#include "base/error.h"
#include "output/exporters/binary_text.h"

#include <zip.h>

#include <cstdlib>
#include <memory>
#include <utility>

namespace sprung {
namespace {

// What comes before the text of an array's head: its magic, version and length (u16).
constexpr std::size_t kPrefix = 10;
constexpr std::size_t kAlignment = 64;

// The first moment that an archive can name, so that equal runs have equal bytes.
constexpr zip_uint16_t kFirstDate = (1U << 5U) | 1U;

using Shape = std::vector<std::size_t>;

/// A .npy file, version 1.0.
std::string npy(const std::string& type, const Shape& shape, const std::string& bytes) {
  std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (";
  for (const std::size_t size : shape) text.append(std::to_string(size)).append(", ");
  text += "), }";
  while ((kPrefix + text.size() + 1) % kAlignment != 0) text += ' ';
  text += '\n';
  std::string file("\x93NUMPY\x01\0", 8);
  append_little(file, static_cast<std::uint16_t>(text.size()));
  return file.append(text).append(bytes);
}

/// A ZIP archive in memory.
class Archive {
 public:
  Archive() {
    zip_error_t error;
    zip_error_init(&error);
    source_ = zip_source_buffer_create(nullptr, 0, 0, &error);
    if (source_ != nullptr) archive_ = zip_open_from_source(source_, ZIP_CREATE | ZIP_TRUNCATE, &error);
    if (archive_ == nullptr) fail(zip_error_strerror(&error));
    zip_source_keep(source_);
  }
  ~Archive() {
    if (archive_ != nullptr) zip_discard(archive_);
    if (source_ != nullptr) zip_source_free(source_);
  }
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  void add(const std::string& name, std::string content) {
    const std::string& kept = *contents_.emplace_back(std::make_unique<std::string>(std::move(content)));
    zip_source_t* source = zip_source_buffer(archive_, kept.data(), kept.size(), 0);
    const zip_int64_t index = source == nullptr ? -1 : zip_file_add(archive_, (name + ".npy").c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) fail(zip_strerror(archive_));
    const auto number = static_cast<zip_uint64_t>(index);
    zip_set_file_compression(archive_, number, ZIP_CM_STORE, 0);
    zip_file_set_dostime(archive_, number, 0, kFirstDate, 0);
  }

  [[nodiscard]] std::string bytes() {
    if (zip_close(archive_) != 0) fail(zip_strerror(archive_));
    archive_ = nullptr;
    zip_stat_t size;
    zip_source_stat(source_, &size);
    std::string all(size.size, '\0');
    zip_source_open(source_);
    const zip_int64_t read = zip_source_read(source_, all.data(), size.size);
    zip_source_close(source_);
    if (read != static_cast<zip_int64_t>(all.size())) fail("it was not written completely");
    return all;
  }

 private:
  [[noreturn]] static void fail(const std::string& reason) { throw FileError("make", "animation.npz", reason); }

  zip_source_t* source_ = nullptr;
  zip_t* archive_ = nullptr;
  std::vector<std::unique_ptr<std::string>> contents_;  ///< that the archive refers to
};

template <class Columns>
std::string index_bytes(const Columns& columns) {
  std::string bytes;
  for (const Index index : columns.reshaped()) append_little(bytes, static_cast<std::int32_t>(index));
  return bytes;
}

}  // namespace

NpzExporter::NpzExporter(ExportedRun run, Precision precision)
    : run_(std::move(run)),
      precision_(precision),
      shapes_(shapes_of(run_.model)),
      positions_(shapes_.size()),
      velocities_(shapes_.size()),
      poses_(shapes_.size()) {}

std::vector<std::string> NpzExporter::losses(bool tears) const {
  std::vector<std::string> losses;
  if (tears) losses.emplace_back("faces that tear stay in animation.npz");
  if (has_materials(run_.model) || has_groups(run_.model))
    losses.emplace_back("animation.npz has no groups and no materials of faces");
  return losses;
}

void NpzExporter::append(std::string& bytes, double number) const {
  if (precision_ == Precision::float32) {
    append_little(bytes, static_cast<float>(number));
  } else {
    append_little(bytes, number);
  }
}

void NpzExporter::append(std::string& bytes, const Points& points) const {
  for (const double coordinate : points.reshaped()) append(bytes, coordinate);
}

std::vector<ExportedFile> NpzExporter::frame(const ExportedFrame& frame) {
  ++frames_;
  append_little(times_, frame.state.time);
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    const ExportedShape& shape = shapes_[k];
    if (shape.body != kNone) {
      const RecordedBody& body = run_.model.bodies[shape.body];
      append(positions_[k], vertices_of(body, frame.state));
      if (frame.state.velocities.cols() > 0) append(velocities_[k], Points(frame.state.velocities(Eigen::all, body.particle_of)));
      continue;
    }
    const ObstacleMotion motion = run_.model.obstacles[shape.obstacle].motion;
    if (motion == ObstacleMotion::deforming) append(positions_[k], vertices_of(run_.model, shape, frame.state));
    if (motion != ObstacleMotion::rigid) continue;
    const Eigen::Matrix4d pose = frame.state.poses[shape.obstacle].matrix();
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) append(poses_[k], pose(row, column));
    }
  }
  return {};
}

std::string NpzExporter::uv_bytes(const PolygonFaces& faces) const {
  std::string bytes;
  for (Index f = 0; f < faces.face_count(); ++f) {
    const Index begin = faces.corner_begin[f];
    for (Index c = begin + 1; c + 1 < faces.corner_begin[f + 1]; ++c) {  // the fan of triangulate()
      for (const Index corner : {begin, c, c + 1}) {
        const Index uv = faces.texcoord[corner];
        for (const std::size_t axis : {0U, 1U}) append(bytes, uv == kNone ? 0.0 : faces.texcoords[uv][axis]);
      }
    }
  }
  return bytes;
}

std::vector<ExportedFile> NpzExporter::end(int /*frames*/) {
  Archive archive;
  archive.add("time", npy("<f8", {frames_}, times_));
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    const ExportedShape& shape = shapes_[k];
    const std::string name = shape.folder + shape.name + "/";
    const Triangles triangles = triangulate(shape.faces);
    const auto faces = static_cast<std::size_t>(triangles.cols());
    archive.add(name + "faces", npy("<i4", {faces, 3}, index_bytes(triangles)));
    if (shape.body != kNone) {
      const std::size_t count = run_.model.bodies[shape.body].particle_of.size();
      archive.add(name + "positions", npy(type(), {frames_, count, 3}, positions_[k]));
      if (!velocities_[k].empty()) archive.add(name + "velocities", npy(type(), {frames_, count, 3}, velocities_[k]));
      archive.add(name + "edges", npy("<i4", {static_cast<std::size_t>(shape.lines.cols()), 2}, index_bytes(shape.lines)));
      if (!shape.faces.texcoord.empty()) archive.add(name + "uv", npy(type(), {faces, 3, 2}, uv_bytes(shape.faces)));
      continue;
    }
    const RecordedObstacle& obstacle = run_.model.obstacles[shape.obstacle];
    const auto count = static_cast<std::size_t>(obstacle.mesh.vertices.cols());
    if (obstacle.motion == ObstacleMotion::deforming) {
      archive.add(name + "positions", npy(type(), {frames_, count, 3}, positions_[k]));
      continue;
    }
    std::string vertices;
    append(vertices, obstacle.mesh.vertices);
    archive.add(name + "vertices", npy(type(), {count, 3}, vertices));
    if (obstacle.motion == ObstacleMotion::rigid) archive.add(name + "poses", npy(type(), {frames_, 4, 4}, poses_[k]));
  }
  return {{"animation.npz", archive.bytes()}};
}

}  // namespace sprung
