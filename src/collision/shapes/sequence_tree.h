// The tree of a mesh sequence: one topology, and boxes for every interval.
#pragma once

#include "collision/mesh_bvh/mesh_bvh.h"
#include "collision/shapes/deforming_mesh.h"

#include <memory>
#include <mutex>
#include <optional>

namespace sprung {

/// The path of the vertices between two frames is divided into segments, about as long as an edge. The boxes of an interval between
/// two frames contain the whole segments around it, so most intervals have the boxes of the one before: the boxes that were fitted
/// last are kept. Thread-safe. What is kept changes no result, as the interval alone decides the boxes.
class SequenceTree {
 public:
  /// The tree is built from the first frame, so a simulation that starts later uses the same tree. Requires a sequence with frames
  /// and triangles.
  explicit SequenceTree(std::shared_ptr<const MeshSequence> sequence);

  [[nodiscard]] DeformingMesh mesh(double begin, double end) const { return {sequence_, around_, begin, end}; }

  /// Replaces `tree` by the tree with boxes that contain each triangle throughout the interval of `mesh`; reuses its memory. The
  /// positions of its triangles are unspecified.
  void fit(const DeformingMesh& mesh, std::optional<MeshBvh>& tree) const;

 private:
  /// Segments `first` up to and without `last` of the `segments` between `frame` and `next`.
  struct Span {
    Index frame = kNone;
    Index next = kNone;
    int segments = 0;
    int first = 0;
    int last = 0;

    bool operator==(const Span&) const = default;
  };
  [[nodiscard]] int segment_count(Index frame, Index next) const;
  [[nodiscard]] Points positions(const Span& span, int segment) const;

  std::shared_ptr<const MeshSequence> sequence_;
  std::shared_ptr<const VertexTriangles> around_;
  double edge_length_;  ///< mean, in the first frame [m]
  mutable std::mutex mutex_;
  mutable MeshBvh fitted_;  ///< to last_
  mutable Span last_;
};

}  // namespace sprung
