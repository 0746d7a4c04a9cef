// A network that hangs by its pins, by Bullet's soft body: its springs are links, which passes of projection hold.
#pragma once

#include "network/spring_network.h"

#include <memory>

namespace sprung::benchmarks {

class BulletHanging {
 public:
  /// Gravity [m/s^2] along -y. A frame [s] is one step of so many passes.
  BulletHanging(const SpringNetwork& network, double gravity, double frame_time, int passes);
  ~BulletHanging();

  void step_frame();
  [[nodiscard]] Points positions() const;  ///< [m]

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace sprung::benchmarks
