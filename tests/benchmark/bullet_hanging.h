// A network that hangs from its pins, simulated by Bullet's soft body. Its springs are links, constrained by passes of projection.
#pragma once

#include "network/model/spring_network.h"

#include <memory>

namespace sprung::benchmarks {

class BulletHanging {
 public:
  /// Gravity [m/s^2] acts along -y. A frame of `frame_time` [s] is one step of `passes` passes.
  BulletHanging(const SpringNetwork& network, double gravity, double frame_time, int passes);
  ~BulletHanging();

  void step_frame();
  [[nodiscard]] Points positions() const;  ///< [m]

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace sprung::benchmarks
