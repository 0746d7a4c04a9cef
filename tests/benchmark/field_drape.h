// The drape that is used to compare simulators: a cloth of 1 m and 0.2 kg starts just above a bunny of 0.6 m, falls onto it and
// then hangs around it.
#pragma once

#include "examples/parity.h"
#include "simulation/simulator.h"

namespace sprung::benchmarks {

inline constexpr double kFrameTime = 1.0 / 60.0;  ///< [s]
inline constexpr double kGravity = 9.81;          ///< [m/s^2]
inline constexpr double kThickness = 0.005;       ///< [m]
inline constexpr double kFriction = 0.3;
/// Projection passes a frame, summed over its steps.
inline constexpr int kPasses = 20;

/// `side` x `side` particles with structural, shear and bend springs of stiffness 0: projection alone carries the cloth.
[[nodiscard]] SpringNetwork drape_network(Index triangles, Index side, bool self_contact = false);

/// The bunny of 0.6 m with about `triangles` triangles.
[[nodiscard]] TriangleMesh drape_mesh(Index triangles);

/// The drape with Sprung's simulator. Like Bullet's links its springs may not stretch; unlike them they may shrink.
class SprungDrape {
 public:
  SprungDrape(Index triangles, Index side, bool self_contact = false);

  void step_frame();
  [[nodiscard]] const Points& positions() const { return simulator_.positions(); }

 private:
  Simulator simulator_;
};

/// Particles inside the bunny, by the parity of the triangles above them.
class InsideCount {
 public:
  explicit InsideCount(Index triangles) : mesh_(drape_mesh(triangles)), parity_(mesh_) {}
  [[nodiscard]] int operator()(const Points& positions) const;

 private:
  TriangleMesh mesh_;
  testing::Parity parity_;
};

}  // namespace sprung::benchmarks
