// glTF 2.0, binary: one file with all frames as morph targets.
#pragma once

#include "output/exporters/exported_shape.h"

namespace tinygltf {
struct Primitive;
}

namespace sprung {

/// `animation.glb`. Each body is a node with a mesh: the vertices of frame 1, a morph target for each other frame, and an animation
/// of the weights. A body has at most 256 targets and 100 MB of them; where the run has more frames, every k-th one and the last
/// are targets. Vertices keep their order; a vertex whose corners have several UVs has copies after all others. Faces of one
/// material are a primitive. Lines are primitives of lines. Rigid obstacles are animated nodes; deforming ones are as bodies.
class GltfExporter final : public Exporter {
 public:
  explicit GltfExporter(ExportedRun run);
  [[nodiscard]] std::vector<std::string> patterns() const override { return {"animation.glb"}; }
  [[nodiscard]] std::vector<std::string> losses(bool tears) const override;
  [[nodiscard]] bool writes_each_frame() const override { return false; }
  [[nodiscard]] std::vector<ExportedFile> frame(const ExportedFrame& frame) override;
  [[nodiscard]] std::vector<ExportedFile> end(int frames) override;

 private:
  class Builder;

  [[nodiscard]] int interval(Index vertices) const;
  // `k` is the number of a shape.
  [[nodiscard]] std::vector<tinygltf::Primitive> primitives(std::size_t k, Builder& builder) const;
  void animate_targets(std::size_t k, int node, Builder& builder) const;
  void animate_pose(std::size_t k, int node, Builder& builder) const;

  ExportedRun run_;
  std::vector<ExportedShape> shapes_;
  std::vector<std::vector<Eigen::Matrix3Xf>> targets_;  ///< of each shape, frame 1 and those that are targets
  std::vector<std::vector<float>> target_times_;        ///< [s], of these
  std::vector<std::vector<RigidTransform>> poses_;      ///< of each rigid obstacle, by frame
  std::vector<float> times_;                            ///< of all frames [s]
};

}  // namespace sprung
