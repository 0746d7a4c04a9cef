// A deforming mesh: vertex positions per frame, with the same triangles in all frames.
#pragma once

#include "geometry/mesh/mesh_report.h"

#include <filesystem>
#include <vector>

namespace sprung {

/// Frames at `frame_rate`, the first at `start`. Between two frames each vertex moves along a straight line.
struct MeshSequence {
  /// A time between two frames.
  struct Moment {
    Index frame = 0;
    Index next = 0;
    double fraction = 0.0;  ///< of the interval from `frame` to `next`, in [0, 1); 0 at a frame
  };

  Triangles triangles;
  std::vector<Points> frames;  ///< positions [m], 3 x n each; at least one frame
  double frame_rate = 30.0;    ///< [1/s], > 0
  double start = 0.0;          ///< time of the first frame [s]
  bool loop = false;  ///< whether the first frame follows the last; else the first stays before `start`, the last after the end

  /// False if no vertex moves in any frame.
  [[nodiscard]] bool deforms() const;

  /// The two frames around a time [s]. A time within 1e-9 frames of a frame is that frame's, so positions there have the frame's
  /// bits.
  [[nodiscard]] Moment at(double time) const;

  /// Lies in the box around the vertex's positions in the two frames, to the last bit.
  [[nodiscard]] Vector3 position(Index vertex, const Moment& moment) const;

  /// Replaces `positions` by those of all vertices [m].
  void positions(const Moment& moment, Points& positions) const;
};

struct ImportedSequence {
  MeshSequence sequence;
  MeshReport report;  ///< of the first frame; its bounds are those of all frames
};

/// `clean_mesh` for all frames alike, so that vertices keep their correspondence. Welds vertices that coincide in every frame and
/// drops faces that have no area in any frame. The first frame decides duplicates, closedness and orientation. Requires finite
/// positions, indices in range and equally many vertices in all frames.
[[nodiscard]] ImportedSequence clean_sequence(MeshSequence raw);

/// Reads one frame from each OBJ file (`polygon_mesh.h`) and cleans them. All files must have the same number of vertices and the
/// same faces. Throws InputError with the problems of all files: those of `read_obj`, files that do not fit the first one, and
/// files without a face that has an area. Requires at least one file.
[[nodiscard]] ImportedSequence import_sequence(const std::vector<std::filesystem::path>& files);

}  // namespace sprung
