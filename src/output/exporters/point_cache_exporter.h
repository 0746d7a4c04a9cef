// PC2 and MDD: the positions of all frames in one file, beside an OBJ file of frame 1.
#pragma once

#include "output/exporters/exported_shape.h"

#include <cstdint>

namespace sprung {

/// PC2 is little-endian: `POINTCACHE2` and a 0, version 1, the number of points, the first frame (0), frames a sample (1), the
/// number of samples, then x, y, z of each point as float. MDD is big-endian: numbers of frames and points, the time of each frame
/// [s] as float, then the same coordinates. Programs such as Blender (modifier Mesh Cache) lay them over a mesh of the same vertex
/// order.
/// Obstacles that do not move have no file.
class PointCacheExporter final : public Exporter {
 public:
  enum class Format : std::uint8_t { pc2, mdd };
  PointCacheExporter(ExportedRun run, Format format);
  [[nodiscard]] std::vector<std::string> patterns() const override;
  [[nodiscard]] std::vector<std::string> losses(bool tears) const override;
  [[nodiscard]] bool writes_each_frame() const override { return false; }
  [[nodiscard]] std::vector<ExportedFile> frame(const ExportedFrame& frame) override;
  [[nodiscard]] std::vector<ExportedFile> end(int frames) override;

 private:
  [[nodiscard]] std::string head(std::size_t points) const;
  [[nodiscard]] const char* ending() const { return format_ == Format::pc2 ? ".pc2" : ".mdd"; }

  ExportedRun run_;
  Format format_;
  std::vector<ExportedShape> shapes_;
  std::vector<std::string> samples_;  ///< of each shape, the bytes of all frames so far
  std::vector<double> times_;         ///< [s]
};

}  // namespace sprung
