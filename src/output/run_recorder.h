// Makes the model and the frames of a record from a simulator.
#pragma once

#include "geometry/obj_source/obj_source.h"
#include "output/record/recorded_model.h"

#include <map>
#include <tuple>
#include <vector>

namespace sprung {

struct Obstacle;
class Simulator;

/// How the record describes the obstacle's motion.
[[nodiscard]] ObstacleMotion motion_of(const Obstacle& obstacle);

class RunRecorder {
 public:
  /// The model is the present one: springs that have broken are not part of it.
  RunRecorder(const Simulator& simulator, const ObjSources& sources, const BodyMaterials& materials);

  [[nodiscard]] const RecordedModel& model() const { return model_; }

  /// The present state. Requires the simulator of the constructor; call it once per frame, in order.
  [[nodiscard]] RecordedFrame frame(const Simulator& simulator);

 private:
  using SpringEnds = std::tuple<Index, Index, SpringKind>;

  void note_broken(const Springs& broken);

  RecordedModel model_;
  std::multimap<SpringEnds, Index> breakable_;  ///< numbers of the springs that have not broken; empty if none can break
  std::vector<char> broken_;                    ///< by spring; empty if none can break
  Index noted_ = 0;                             ///< springs that broke and are in `broken_`
};

}  // namespace sprung
