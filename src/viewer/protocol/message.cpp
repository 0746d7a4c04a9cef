#include "viewer/protocol/message.h"

#include <bit>
#include <cstring>

namespace sprung {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

enum class MessageKind : std::uint32_t { topology = 1, frame = 2 };

/// Appends numbers to bytes.
class Writer {
 public:
  explicit Writer(Bytes& bytes) : bytes_(bytes) {}

  template <class Number>
  void number(Number value) {
    const std::size_t begin = bytes_.size();
    bytes_.resize(begin + sizeof(Number));
    std::memcpy(&bytes_[begin], &value, sizeof(Number));
  }

  void count(std::ptrdiff_t value) { number(static_cast<std::uint32_t>(value)); }

  /// The entries of an Eigen array, column after column, as `Number`.
  template <class Number, class Array>
  void array(const Array& values) {
    const std::size_t begin = bytes_.size();
    const auto size = static_cast<std::size_t>(values.size());
    bytes_.resize(begin + size * sizeof(Number));
    for (std::size_t k = 0; k < size; ++k) {
      const auto value = static_cast<Number>(values.data()[k]);
      std::memcpy(&bytes_[begin + k * sizeof(Number)], &value, sizeof(Number));
    }
  }

 private:
  Bytes& bytes_;
};

void write_header(MessageKind kind, const MessageHeader& header, Index particles, Writer& writer) {
  writer.number(static_cast<std::uint32_t>(kind));
  writer.number(header.run);
  writer.number(header.generation);
  writer.number(header.frame);
  writer.number(header.time);
  writer.count(particles);
  writer.number(static_cast<std::uint32_t>(header.playing ? 1 : 0));
}

}  // namespace

Bytes topology_message(const MessageHeader& header, const Topology& topology) {
  Bytes bytes;
  Writer writer(bytes);
  write_header(MessageKind::topology, header, topology.particles, writer);
  writer.count(topology.triangles.cols());
  writer.count(topology.segments.cols());
  writer.count(topology.springs.cols());
  writer.count(static_cast<std::ptrdiff_t>(topology.obstacles.size()));
  for (const TriangleMesh& obstacle : topology.obstacles) {
    writer.count(obstacle.vertices.cols());
    writer.count(obstacle.triangles.cols());
  }
  writer.array<std::uint32_t>(topology.triangles);
  writer.array<std::uint32_t>(topology.segments);
  writer.array<std::uint32_t>(topology.springs);
  writer.array<float>(topology.rest_lengths);
  writer.array<std::uint32_t>(topology.kinds);
  for (const TriangleMesh& obstacle : topology.obstacles) {
    writer.array<float>(obstacle.vertices);
    writer.array<std::uint32_t>(obstacle.triangles);
  }
  return bytes;
}

Bytes frame_message(const MessageHeader& header, const FrameNumbers& numbers, const FrameState& state) {
  Bytes bytes;
  bytes.reserve(64 + static_cast<std::size_t>(17 * state.positions.cols()));
  Writer writer(bytes);
  write_header(MessageKind::frame, header, static_cast<Index>(state.positions.cols()), writer);
  for (const double value :
       {numbers.kinetic, numbers.elastic, numbers.gravity, numbers.max_stretch, static_cast<double>(numbers.contacts),
        numbers.frame_ms, numbers.realtime, static_cast<double>(numbers.infeasible), numbers.contact_energy, numbers.pull}) {
    writer.number(static_cast<float>(value));
  }
  writer.array<float>(state.positions);
  writer.array<float>(state.speeds);
  writer.array<std::uint8_t>(state.states);
  while (bytes.size() % sizeof(float) != 0) bytes.push_back(0);
  for (const RigidTransform& pose : state.poses) {
    const Matrix3 rows = pose.linear().transpose();
    writer.array<float>(rows);
    writer.array<float>(Vector3(pose.translation()));
  }
  for (const Points& vertices : state.deformed) writer.array<float>(vertices);
  for (Index i = 0; i < static_cast<Index>(state.contact_forces.cols()); ++i) {
    if ((state.states[static_cast<std::size_t>(i)] & kHasForce) != 0) writer.array<float>(Vector3(state.contact_forces.col(i)));
  }
  return bytes;
}

}  // namespace sprung
