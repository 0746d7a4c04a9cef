// The drape of field_drape.h by Bullet's soft body, as well as it can do it: all lengths times ten, since Bullet takes a triangle
// for a prism 0.06 thick, cells of its distance field a tenth of a unit large, 4 steps a frame of 5 passes.
#pragma once

#include "base/types.h"

#include <memory>

namespace sprung::benchmarks {

class BulletDrape {
 public:
  BulletDrape(Index triangles, Index side);
  ~BulletDrape();

  void step_frame();
  [[nodiscard]] Points positions() const;  ///< [m]

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace sprung::benchmarks
