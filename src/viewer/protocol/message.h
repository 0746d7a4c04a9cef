// The binary messages to the page; PROTOCOL.md describes them byte by byte.
#pragma once

#include "output/record/recorded_model.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace sprung {

using Bytes = std::vector<std::uint8_t>;
using SharedBytes = std::shared_ptr<const Bytes>;

/// What a message is about.
struct MessageHeader {
  std::uint32_t run = 0;
  std::uint32_t generation = 0;
  std::uint32_t frame = 1;
  double time = 0.0;  ///< [s]
  bool playing = false;
};

/// Surfaces and springs of a run; indices are those of the network's particles.
struct Topology {
  Triangles triangles{3, 0};
  Edges segments{2, 0};
  Edges springs{2, 0};
  std::vector<float> rest_lengths;  ///< [m], of the springs
  std::vector<std::uint32_t> kinds;
  std::vector<TriangleMesh> obstacles;  ///< in the frame of the obstacle, or in the world's if it is fixed
  Index particles = 0;
};

/// Appends elements whose vertices count from `offset` on.
template <class Elements>
void append_columns(const Elements& more, Index offset, Elements& all) {
  const Eigen::Index begin = all.cols();
  all.conservativeResize(Eigen::NoChange, begin + more.cols());
  all.rightCols(more.cols()) = more.array() + offset;
}

/// Numbers of a frame, see FrameDiagnostics.
struct FrameNumbers {
  double kinetic = 0.0;
  double elastic = 0.0;
  double gravity = 0.0;
  double max_stretch = 0.0;
  Index contacts = 0;
  double frame_ms = 0.0;
  double realtime = 0.0;  ///< factor to real time that is reached
  Index infeasible = 0;
  double contact_energy = 0.0;
  double pull = 0.0;  ///< the force of the hand [N]
};

/// The state of a particle on which contact acted in the frame, with a force that is known; see also kInContact.
inline constexpr std::uint8_t kHasForce = 4;

/// The state of a run.
struct FrameState {
  Points positions{3, 0};               ///< [m]
  Scalars speeds{};                     ///< [m/s]
  std::vector<std::uint8_t> states;     ///< of particles: kInContact, kPinned, kHasForce
  std::vector<RigidTransform> poses{};  ///< of rigid obstacles that move
  std::vector<Points> deformed{};       ///< vertices of deforming obstacles [m]
  Points contact_forces{3, 0};          ///< [N], of all particles; empty if they are not known
};

[[nodiscard]] Bytes topology_message(const MessageHeader& header, const Topology& topology);

/// Requires as many speeds and states as positions.
[[nodiscard]] Bytes frame_message(const MessageHeader& header, const FrameNumbers& numbers, const FrameState& state);

}  // namespace sprung
