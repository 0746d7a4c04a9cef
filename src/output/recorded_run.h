// Reads what a run wrote: its record, its diagnostics and its frames.
#pragma once

#include "geometry/mesh/polygon_mesh.h"
#include "output/run_record.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sprung {

/// A body or an obstacle of a run.
struct RecordedMesh {
  std::string name;
  std::string pattern;  ///< of its files, see file_pattern.h
  PolygonMesh first;    ///< its first file

  /// Whether there is a file for each frame.
  [[nodiscard]] bool changes() const { return pattern.find('#') != std::string::npos; }
};

/// The table of diagnostics.csv; fields without a value are NaN.
struct RecordedDiagnostics {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;  ///< one per frame, each as long as the columns
};

class RecordedRun {
 public:
  /// Throws InputError that names what a folder lacks to be a run with at least one frame: run.json, its keys, or the files of its
  /// first frame.
  explicit RecordedRun(std::filesystem::path folder);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const std::string& scene() const { return scene_; }  ///< JSON text; empty if the run has none
  [[nodiscard]] int frames() const { return frames_; }               ///< that were written
  [[nodiscard]] double frame_rate() const { return frame_rate_; }    ///< [1/s]
  [[nodiscard]] double step() const { return step_; }                ///< [s]
  [[nodiscard]] int steps_per_frame() const { return steps_per_frame_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
  [[nodiscard]] const std::vector<RecordedMesh>& bodies() const { return bodies_; }
  [[nodiscard]] const std::vector<RecordedMesh>& obstacles() const { return obstacles_; }
  [[nodiscard]] const RecordedDiagnostics& diagnostics() const { return diagnostics_; }
  [[nodiscard]] const std::vector<TornFaces>& torn_faces() const { return torn_faces_; }

  /// Positions of a mesh in a frame, counted from 1 [m], 3 x n. Throws InputError if the file cannot be read or has another number
  /// of vertices than the first one.
  [[nodiscard]] Points positions(const RecordedMesh& mesh, int frame) const;

 private:
  void read_record();
  void read_meshes(const std::vector<std::string>& patterns);
  void read_diagnostics();
  void read_torn_faces(const std::string& record);

  std::filesystem::path folder_;
  std::string scene_;
  int frames_ = 0;
  double frame_rate_ = 30.0;
  double step_ = 0.0;
  int steps_per_frame_ = 1;
  std::vector<std::string> warnings_;
  std::vector<RecordedMesh> bodies_;
  std::vector<RecordedMesh> obstacles_;
  RecordedDiagnostics diagnostics_;
  std::vector<TornFaces> torn_faces_;
};

}  // namespace sprung
