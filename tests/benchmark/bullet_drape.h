// The drape of field_drape.h with Bullet's soft body and its best settings. All lengths are multiplied by ten, as Bullet treats a
// triangle as a prism 0.06 thick; cells of its distance field are 0.1 wide; a frame has 4 steps of 5 passes.
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
