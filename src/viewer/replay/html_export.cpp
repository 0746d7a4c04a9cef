#include "viewer/replay/html_export.h"

#include "viewer/protocol/base64.h"

#include <zlib.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <utility>

namespace sprung {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLevels = 65535.0;

Bytes compressed(const Bytes& bytes) {
  uLongf size = compressBound(bytes.size());
  Bytes result(size);
  if (compress(result.data(), &size, bytes.data(), bytes.size()) != Z_OK) throw std::bad_alloc();
  result.resize(size);
  return result;
}

/// Rounds positions to levels within a box.
class Quantiser {
 public:
  /// Requires a box that is not empty.
  explicit Quantiser(const Box3& bounds) : min_(bounds.min()), size_(bounds.sizes()) {
    for (Eigen::Index d = 0; d < 3; ++d) {
      if (size_[d] == 0.0) size_[d] = 1.0;
    }
  }

  void append(const Points& points, std::vector<std::uint16_t>& levels) {
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      for (Eigen::Index d = 0; d < 3; ++d) {
        const double level = std::clamp(std::round((points(d, i) - min_[d]) / size_[d] * kLevels), 0.0, kLevels);
        error_ = std::max(error_, std::abs(min_[d] + size_[d] * level / kLevels - points(d, i)));
        levels.push_back(static_cast<std::uint16_t>(level));
      }
    }
  }

  [[nodiscard]] Json bounds() const { return {{"min", {min_[0], min_[1], min_[2]}}, {"size", {size_[0], size_[1], size_[2]}}}; }
  [[nodiscard]] double error() const { return error_; }

 private:
  Vector3 min_;
  Vector3 size_;
  double error_ = 0.0;
};

std::vector<std::uint16_t> levels_of(const FrameState& state, Quantiser& quantiser) {
  std::vector<std::uint16_t> levels;
  quantiser.append(state.positions, levels);
  for (const Points& vertices : state.deformed) quantiser.append(vertices, levels);
  return levels;
}

/// Differences to the levels before, modulo 2^16: all low bytes, then all high bytes. High bytes are nearly all 0 or 255, which
/// zlib stores in little space.
void append_differences(const std::vector<std::uint16_t>& before, const std::vector<std::uint16_t>& levels, Bytes& bytes) {
  for (const unsigned shift : {0U, 8U}) {
    for (std::size_t k = 0; k < levels.size(); ++k) {
      const auto difference = static_cast<std::uint16_t>(levels[k] - before[k]);
      bytes.push_back(static_cast<std::uint8_t>(difference >> shift));
    }
  }
}

Box3 bounds_of(const Points& points, Box3 box) {
  for (Eigen::Index i = 0; i < points.cols(); ++i) box.extend(Vector3(points.col(i)));
  return box;
}

/// JSON within HTML: nothing in it may end the element.
std::string escaped(std::string text) {
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) text.replace(at, 1, "\\u003c");
  return text;
}

/// The states of a frame as differences to those of the frame before, modulo 256.
void append_states(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& states, Bytes& bytes) {
  for (std::size_t k = 0; k < states.size(); ++k) bytes.push_back(static_cast<std::uint8_t>(states[k] - before[k]));
}

/// Rotation by rows, then position, of each rigid obstacle.
Json poses_of(const FrameState& state) {
  Json poses = Json::array();
  for (const RigidTransform& pose : state.poses) {
    Json numbers = Json::array();
    for (int k = 0; k < 9; ++k) numbers.push_back(pose.linear()(k / 3, k % 3));
    for (int k = 0; k < 3; ++k) numbers.push_back(pose.translation()[k]);
    poses.push_back(numbers);
  }
  return poses;
}

bool begins_path(std::string_view text) {
  return text.starts_with('/') || text.starts_with("~/") || text.starts_with("./") || text.starts_with("../");
}

/// Cuts each path to its file name, so that the page does not reveal folders of the machine.
std::string without_folders(const std::string& text) {
  constexpr std::string_view kAround = " \t\n\"'(),;:=";
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(kAround, at), text.size());
    const std::string_view word = std::string_view(text).substr(at, end - at);
    result += begins_path(word) ? word.substr(word.rfind('/') + 1) : word;
    if (end < text.size()) result += text[end];
    at = end + 1;
  }
  return result;
}

/// Applies without_folders() to all texts. A value of `file` or `files` is one path, which may contain blanks.
void remove_folders(Json& json, const std::string& key = "") {
  if (json.is_object()) {
    for (auto& [name, value] : json.items()) remove_folders(value, name);
  } else if (json.is_array()) {
    for (Json& value : json) remove_folders(value, key);
  } else if (json.is_string()) {
    const std::string text = json.get<std::string>();
    json = key == "file" || key == "files" ? text.substr(text.rfind('/') + 1) : without_folders(text);
  }
}

}  // namespace

HtmlAnimation html_animation(const Replay& replay, const std::string& page) {
  constexpr std::string_view kEnd = "</head>";
  const std::size_t place = page.find(kEnd);
  if (place == std::string::npos) throw std::logic_error("the viewer's page has no head");
  const int count = replay.run().frames();
  Box3 box;
  for (int frame = 1; frame <= count; ++frame) {
    const FrameState state = replay.state(frame);
    box = bounds_of(state.positions, box);
    for (const Points& vertices : state.deformed) box = bounds_of(vertices, box);
  }
  Quantiser quantiser(box);
  Bytes bytes = topology_message({.run = 0, .generation = 1}, replay.topology());
  const std::size_t topology_bytes = bytes.size();
  Bytes state_bytes;
  Json times = Json::array();
  Json poses = Json::array();
  std::vector<std::uint16_t> before;
  std::vector<std::uint8_t> states_before;
  for (int frame = 1; frame <= count; ++frame) {
    const FrameState state = replay.state(frame);
    std::vector<std::uint16_t> levels = levels_of(state, quantiser);
    before.resize(levels.size());  // zeros before the first frame
    states_before.resize(state.states.size());
    append_differences(before, levels, bytes);
    append_states(states_before, state.states, state_bytes);
    before = std::move(levels);
    states_before = state.states;
    times.push_back(replay.time(frame));
    poses.push_back(poses_of(state));
  }
  const std::size_t level_bytes = bytes.size() - topology_bytes;
  bytes.insert(bytes.end(), state_bytes.begin(), state_bytes.end());
  Json scene = Json::parse(replay.scene_text());
  remove_folders(scene);
  const Json data{{"scene", std::move(scene)},  {"bounds", quantiser.bounds()},     {"error", quantiser.error()},
                  {"times", std::move(times)},  {"poses", std::move(poses)},        {"topology_bytes", topology_bytes},
                  {"level_bytes", level_bytes}, {"data", base64(compressed(bytes))}};
  const std::string element = "<script type=\"application/json\" id=\"sprung-run\">" + escaped(data.dump()) + "</script>";
  return {.text = page.substr(0, place) + element + page.substr(place), .error = quantiser.error()};
}

}  // namespace sprung
