// Numbers as bytes, in a given order.
#pragma once

#include "base/types.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

namespace sprung {

template <class Number>
void append_bytes(std::string& bytes, Number number, std::endian order) {
  std::array<char, sizeof(Number)> raw{};
  std::memcpy(raw.data(), &number, sizeof(Number));
  if (order != std::endian::native) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

/// Little-endian.
template <class Number>
void append_little(std::string& bytes, Number number) {
  append_bytes(bytes, number, std::endian::little);
}

/// The coordinates of points as Number, little-endian, x, y, z of the first one first.
template <class Number>
void append_points(std::string& bytes, const Points& points, std::endian order = std::endian::little) {
  bytes.reserve(bytes.size() + static_cast<std::size_t>(points.size()) * sizeof(Number));
  for (const double coordinate : points.reshaped()) append_bytes(bytes, static_cast<Number>(coordinate), order);
}

}  // namespace sprung
