#include "viewer/html_export.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace sprung {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLevels = 65535.0;

std::string base64(const std::uint8_t* bytes, std::size_t size) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t k = 0; k < size; k += 3) {
    const std::uint32_t second = k + 1 < size ? bytes[k + 1] : 0U;
    const std::uint32_t third = k + 2 < size ? bytes[k + 2] : 0U;
    const std::uint32_t three = (static_cast<std::uint32_t>(bytes[k]) << 16U) | (second << 8U) | third;
    text += kDigits[three >> 18U];
    text += kDigits[(three >> 12U) & 63U];
    text += k + 1 < size ? kDigits[(three >> 6U) & 63U] : '=';
    text += k + 2 < size ? kDigits[three & 63U] : '=';
  }
  return text;
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

  /// Base 64 of the levels, u16[3n].
  [[nodiscard]] std::string text(const Points& points) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(static_cast<std::size_t>(6 * points.cols()));
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      for (Eigen::Index d = 0; d < 3; ++d) {
        const double level = std::clamp(std::round((points(d, i) - min_[d]) / size_[d] * kLevels), 0.0, kLevels);
        error_ = std::max(error_, std::abs(min_[d] + size_[d] * level / kLevels - points(d, i)));
        const auto number = static_cast<std::uint16_t>(level);
        bytes.push_back(static_cast<std::uint8_t>(number & 255U));
        bytes.push_back(static_cast<std::uint8_t>(number >> 8U));
      }
    }
    return base64(bytes.data(), bytes.size());
  }

  [[nodiscard]] Json bounds() const { return {{"min", {min_[0], min_[1], min_[2]}}, {"size", {size_[0], size_[1], size_[2]}}}; }
  [[nodiscard]] double error() const { return error_; }

 private:
  Vector3 min_;
  Vector3 size_;
  double error_ = 0.0;
};

Box3 bounds_of(const Points& points, Box3 box) {
  for (Eigen::Index i = 0; i < points.cols(); ++i) box.extend(Vector3(points.col(i)));
  return box;
}

/// JSON within HTML: nothing in it may end the element.
std::string escaped(std::string text) {
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) text.replace(at, 1, "\\u003c");
  return text;
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
  Json frames = Json::array();
  for (int frame = 1; frame <= count; ++frame) {
    const FrameState state = replay.state(frame);
    Json obstacles = Json::array();
    for (const Points& vertices : state.deformed) obstacles.push_back(quantiser.text(vertices));
    frames.push_back({{"time", replay.time(frame)}, {"positions", quantiser.text(state.positions)}, {"obstacles", obstacles}});
  }
  const Bytes topology = topology_message({.run = 0, .generation = 1}, replay.topology());
  const Json data{{"scene", Json::parse(replay.scene_text())},
                  {"topology", base64(topology.data(), topology.size())},
                  {"bounds", quantiser.bounds()},
                  {"error", quantiser.error()},
                  {"frames", frames}};
  const std::string element = "<script type=\"application/json\" id=\"sprung-run\">" + escaped(data.dump()) + "</script>";
  return {.text = page.substr(0, place) + element + page.substr(place), .error = quantiser.error()};
}

}  // namespace sprung
