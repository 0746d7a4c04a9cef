// NPZ: all frames as NumPy arrays in one file.
#pragma once

#include "output/exporters/exported_shape.h"

#include <cstdint>

namespace sprung {

/// `animation.npz`, an uncompressed archive (ZIP64 where it is large). `numpy.load` gives, for each body NAME, `NAME/positions` [m]
/// and `NAME/velocities` [m/s], (frames, n, 3); `NAME/faces`, (m, 3), polygons cut into fans; `NAME/edges`, (k, 2), of lines; with
/// UVs `NAME/uv`, (m, 3, 2), of the corners of these faces. Also `time`, (frames) [s], and for each obstacle
/// `obstacles/NAME/faces`, and `obstacles/NAME/vertices`, (v, 3), with `obstacles/NAME/poses`, (frames, 4, 4), if it moves, or
/// `obstacles/NAME/positions`, (frames, v, 3), if it deforms. Positions, velocities, UVs and poses have the given precision.
class NpzExporter final : public Exporter {
 public:
  enum class Precision : std::uint8_t { float32, float64 };
  NpzExporter(ExportedRun run, Precision precision);
  [[nodiscard]] std::vector<std::string> patterns() const override { return {"animation.npz"}; }
  [[nodiscard]] std::vector<std::string> losses(bool tears) const override;
  [[nodiscard]] bool writes_each_frame() const override { return false; }
  [[nodiscard]] std::vector<ExportedFile> frame(const ExportedFrame& frame) override;
  [[nodiscard]] std::vector<ExportedFile> end(int frames) override;

 private:
  [[nodiscard]] const char* type() const { return precision_ == Precision::float32 ? "<f4" : "<f8"; }
  void append(std::string& bytes, const Points& points) const;
  void append(std::string& bytes, double number) const;
  [[nodiscard]] std::string uv_bytes(const PolygonFaces& faces) const;

  ExportedRun run_;
  Precision precision_;
  std::vector<ExportedShape> shapes_;
  // The bytes of all frames so far, by shape.
  std::vector<std::string> positions_;
  std::vector<std::string> velocities_;
  std::vector<std::string> poses_;
  std::string times_;
  std::size_t frames_ = 0;
};

}  // namespace sprung
