// A jelly that falls on a floor, simulated by Bullet's soft body: its springs are links, and it conserves its volume.
#pragma once

#include "network/model/spring_network.h"

#include <memory>

namespace sprung::benchmarks {

class BulletJelly {
 public:
  /// The floor is the plane y = 0. Gravity [m/s^2] acts along -y. A step of `dt` [s] makes `passes` passes.
  BulletJelly(const SpringNetwork& network, double gravity, double dt, int passes);
  ~BulletJelly();

  void step();
  [[nodiscard]] Points positions() const;  ///< [m]

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace sprung::benchmarks
