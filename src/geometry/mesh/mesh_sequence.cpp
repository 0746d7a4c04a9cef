#include "geometry/mesh/mesh_sequence.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

// Rounding may separate the time of a step from that of a frame: tolerance in frames.
constexpr double kSameFrame = 1e-9;

}  // namespace

bool MeshSequence::deforms() const {
  return std::any_of(frames.begin(), frames.end(), [&](const Points& frame) { return frame != frames.front(); });
}

MeshSequence::Moment MeshSequence::at(double time) const {
  const auto count = static_cast<double>(frames.size());
  const double last = count - 1.0;
  double time_in_frames = (time - start) * frame_rate;
  const double nearest = std::round(time_in_frames);
  if (std::abs(time_in_frames - nearest) <= kSameFrame) time_in_frames = nearest;
  if (loop) {
    time_in_frames -= count * std::floor(time_in_frames / count);
    if (time_in_frames >= count) time_in_frames = 0.0;  // a small negative number, rounded
  } else {
    time_in_frames = std::clamp(time_in_frames, 0.0, last);
  }
  const double frame = std::floor(time_in_frames);
  const double next = frame < last ? frame + 1.0 : loop ? 0.0 : last;
  return {static_cast<Index>(frame), static_cast<Index>(next), time_in_frames - frame};
}

// a + fraction (b - a) has the bits of a if the frames agree, and never passes b: fraction < 1 removes at least as much as
// rounding of b - a may have added.
Vector3 MeshSequence::position(Index vertex, const Moment& moment) const {
  const Vector3 a = frames[moment.frame].col(vertex);
  const Vector3 b = frames[moment.next].col(vertex);
  return a + moment.fraction * (b - a);
}

void MeshSequence::positions(const Moment& moment, Points& positions) const {
  const Points& a = frames[moment.frame];
  const Points& b = frames[moment.next];
  positions = a + moment.fraction * (b - a);
}

}  // namespace sprung
