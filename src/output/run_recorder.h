// Makes the model and the frames of a record from a simulator.
#pragma once

#include "geometry/obj_source/obj_source.h"
#include "output/record/recorded_model.h"

namespace sprung {

struct Obstacle;
class Simulator;

/// How the record describes the obstacle's motion.
[[nodiscard]] ObstacleMotion motion_of(const Obstacle& obstacle);

class RunRecorder {
 public:
  /// The model is that of the simulator, also with springs that have broken.
  RunRecorder(const Simulator& simulator, const ObjSources& sources, const BodyMaterials& materials);

  [[nodiscard]] const RecordedModel& model() const { return model_; }

  /// The present state of a simulator.
  [[nodiscard]] static RecordedFrame frame(const Simulator& simulator);

 private:
  RecordedModel model_;
};

}  // namespace sprung
