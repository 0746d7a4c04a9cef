#include "geometry/mesh/mesh_sequence.h"

#include <algorithm>
#include <cmath>

namespace sprung {

namespace {

// Times are multiples of a step, frames are at multiples of another: what rounding may leave between them, as a part of a frame.
constexpr double kSameFrame = 1e-9;

}  // namespace

bool MeshSequence::deforms() const {
  return std::any_of(frames.begin(), frames.end(), [&](const Points& frame) { return frame != frames.front(); });
}

MeshSequence::Moment MeshSequence::at(double time) const {
  const auto count = static_cast<double>(frames.size());
  const double last = count - 1.0;
  double place = (time - start) * frame_rate;
  const double nearest = std::round(place);
  if (std::abs(place - nearest) <= kSameFrame) place = nearest;
  if (loop) {
    place -= count * std::floor(place / count);
    if (place >= count) place = 0.0;  // a small negative one, rounded
  } else {
    place = std::clamp(place, 0.0, last);
  }
  const double frame = std::floor(place);
  const double next = frame < last ? frame + 1.0 : loop ? 0.0 : last;
  return {static_cast<Index>(frame), static_cast<Index>(next), place - frame};
}

// a + part (b - a) has a's bits where the frames agree, and never passes b: part < 1 takes at least as much off as rounding of
// b - a may have added.
Vector3 MeshSequence::position(Index vertex, const Moment& moment) const {
  const Vector3 a = frames[moment.frame].col(vertex);
  const Vector3 b = frames[moment.next].col(vertex);
  return a + moment.part * (b - a);
}

void MeshSequence::positions(const Moment& moment, Points& positions) const {
  const Points& a = frames[moment.frame];
  const Points& b = frames[moment.next];
  positions = a + moment.part * (b - a);
}

}  // namespace sprung
