// Bodies and obstacles as one kind of thing: vertices, faces and lines that move.
#pragma once

#include "output/exporters/exporter.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sprung {

/// A body or an obstacle of a recorded model.
struct ExportedShape {
  std::string name;        ///< of the body or the obstacle
  std::string folder;      ///< that holds its files, with a / at the end; empty: that of the export
  Index body = kNone;      ///< its number among the bodies; kNone: it is an obstacle
  Index obstacle = kNone;  ///< likewise
  bool changes = true;     ///< whether its vertices move
  PolygonFaces faces;
  Edges lines{2, 0};

  /// `NAME/NAME` for a sequence of files, `obstacles/NAME` for one file.
  [[nodiscard]] std::string stem() const { return changes ? folder + name + "/" + name : folder + name; }
};

/// All bodies, then all obstacles.
[[nodiscard]] std::vector<ExportedShape> shapes_of(const RecordedModel& model);

/// The vertices of a shape in a frame, in the world [m], 3 x n.
[[nodiscard]] Points vertices_of(const RecordedModel& model, const ExportedShape& shape, const RecordedFrame& frame);

/// The faces of a shape that are there in a frame.
[[nodiscard]] PolygonFaces faces_in(const ExportedShape& shape, const ExportedFrame& frame);

/// Whether faces have materials, or several groups.
[[nodiscard]] bool has_materials(const RecordedModel& model);
[[nodiscard]] bool has_groups(const RecordedModel& model);

/// What is known of the vertices of a body in a frame.
struct VertexState {
  Points velocities;                  ///< [m/s], 3 x n
  std::vector<float> stretch;         ///< the largest of its structural springs that are not broken, (|s| - d) / d; 0 without any
  std::vector<std::uint8_t> contact;  ///< 1: contact pushed it in the last step
};
[[nodiscard]] VertexState vertex_state(const RecordedModel& model, const RecordedBody& body, const RecordedFrame& frame);

}  // namespace sprung
