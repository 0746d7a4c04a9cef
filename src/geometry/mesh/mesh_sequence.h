// A mesh that deforms: the positions of its vertices frame by frame, its triangles the same in all of them.
#pragma once

#include "geometry/mesh/mesh_report.h"

#include <filesystem>
#include <vector>

namespace sprung {

/// Frames that follow each other at `frame_rate` from `start` on; in between each vertex moves along a straight line.
struct MeshSequence {
  /// Between two frames: `part` of the way from one to the next.
  struct Moment {
    Index frame = 0;
    Index next = 0;
    double part = 0.0;  ///< in [0, 1); 0 at a frame
  };

  Triangles triangles;
  std::vector<Points> frames;  ///< positions [m], 3 x n each; at least one
  double frame_rate = 30.0;    ///< [1/s], > 0
  double start = 0.0;          ///< time of the first frame [s]
  bool loop = false;           ///< the last frame leads on to the first, for ever; else the first is held before, the last after

  /// False when every vertex is at the same place in all frames.
  [[nodiscard]] bool deforms() const;

  /// A time within 1e-9 of a frame's is that frame's, so that what is computed at a frame's time has the frame's bits.
  [[nodiscard]] Moment at(double time) const;

  /// Within the box of the two frames' positions, to the last bit.
  [[nodiscard]] Vector3 position(Index vertex, const Moment& moment) const;

  /// Replaces `positions` by those of all vertices.
  void positions(const Moment& moment, Points& positions) const;
};

struct ImportedSequence {
  MeshSequence sequence;
  MeshReport report;  ///< of the first frame; its bounds are those of all frames
};

/// `clean_mesh` for all frames alike, so that vertices keep their correspondence: welded is what coincides in every frame, dropped
/// is a face that has no area in any; duplicates, closedness and orientation are those of the first frame.
/// Requires finite positions, indices in range and as many vertices in each frame.
[[nodiscard]] ImportedSequence clean_sequence(MeshSequence raw);

/// Reads a frame from each of the OBJ files (`polygon_mesh.h`), which must have the same number of vertices and the same faces,
/// and cleans them. Throws InputError with the problems of all files: those of `read_obj`, and files that do not fit the first or
/// have no face with an area. Requires at least one file.
[[nodiscard]] ImportedSequence import_sequence(const std::vector<std::filesystem::path>& files);

}  // namespace sprung
