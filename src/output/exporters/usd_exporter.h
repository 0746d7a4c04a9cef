// USD as text: meshes with time samples.
#pragma once

#include "output/exporters/exported_shape.h"

namespace sprung {

/// `animation.usda`: Y is up, the unit is 1 m, time codes are frames. Bodies with faces are `Mesh` prims with time samples of
/// points (float) and, where faces tear, of the faces; UVs are `primvars:st`, groups and materials of faces are `GeomSubset` prims.
/// Lines are `BasisCurves`, a curve for each line. Obstacles are `Mesh` prims: fixed ones as they stand, rigid ones with time
/// samples of their transform, deforming ones of their points.
/// Of names `-` becomes `_`, with another `_` at the end where two would be equal.
class UsdExporter final : public Exporter {
 public:
  explicit UsdExporter(ExportedRun run);
  [[nodiscard]] std::vector<std::string> losses(bool tears) const override;
  [[nodiscard]] std::vector<std::string> patterns() const override { return {"animation.usda"}; }
  [[nodiscard]] bool writes_each_frame() const override { return false; }
  [[nodiscard]] std::vector<ExportedFile> frame(const ExportedFrame& frame) override;
  [[nodiscard]] std::vector<ExportedFile> end(int frames) override;

 private:
  /// Text of the samples so far, without the brackets around them.
  struct Samples {
    std::string points;
    std::string curves;
    std::string counts;   ///< faceVertexCounts; a sample where it changes
    std::string indices;  ///< faceVertexIndices
    std::string texcoords;
    std::string transform;
    std::size_t torn = 0;  ///< faces that are gone at the last sample
  };

  void add_faces(const PolygonFaces& faces, int frame, Samples& to) const;
  [[nodiscard]] std::string mesh_text(const std::string& name, const ExportedShape& shape, const Samples& samples) const;

  ExportedRun run_;
  std::vector<ExportedShape> shapes_;
  std::vector<Samples> samples_;
};

}  // namespace sprung
