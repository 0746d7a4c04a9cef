// Scenes that the viewer shows in its tests.
#pragma once

namespace sprung::testing {

// A rope that hangs from its first particle, and an obstacle below.
inline constexpr const char* kScene = R"({"version": 1, "duration": 1, "frame_rate": 50, "step": 0.002,
  "bodies": {"rope": {"shape": {"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "particles": 11}, "mass": 0.1,
                      "springs": {"structural": {"stiffness": 100, "damping": 0.1}}, "pins": [{"indices": [0]}]}},
  "obstacles": {"ball": {"shape": {"type": "sphere", "radius": 0.2}, "place": {"position": [0.5, -2, 0]}}}})";

// The step of 0.02 s is beyond the largest stable one.
inline constexpr const char* kDivergingScene =
    R"({"version": 1, "duration": 10, "frame_rate": 50, "step": 0.02, "stability": "warn",
  "integrator": {"type": "symplectic_euler"},
  "bodies": {"rope": {"shape": {"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "particles": 11}, "mass": 0.1,
                      "springs": {"structural": {"stiffness": 10000}}, "pins": [{"indices": [0]}]}}})";

}  // namespace sprung::testing
