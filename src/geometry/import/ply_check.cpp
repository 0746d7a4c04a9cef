#include "geometry/import/mesh_check.h"
#include "geometry/import/mesh_file.h"
#include "geometry/import/text_words.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace sprung {
namespace {

enum class Kind { integer, natural, real };

struct Type {
  std::size_t size = 0;  // bytes of a binary value
  Kind kind = Kind::real;
};

struct Property {
  std::string name;
  Type type;
  std::optional<Type> count;  // of a list
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

enum class Format { ascii, little_endian, big_endian };

struct Header {
  std::optional<Format> format;
  std::vector<Element> elements;
};

const Element* find(const Header& header, std::string_view name) {
  const auto found = std::find_if(header.elements.begin(), header.elements.end(), [&](const Element& e) { return e.name == name; });
  return found == header.elements.end() ? nullptr : &*found;
}

class InvalidPly : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

Type type_of(std::string_view name) {
  static const std::map<std::string_view, Type> kTypes{
      {"char", {1, Kind::integer}},  {"uchar", {1, Kind::natural}},  {"short", {2, Kind::integer}}, {"ushort", {2, Kind::natural}},
      {"int", {4, Kind::integer}},   {"uint", {4, Kind::natural}},   {"float", {4, Kind::real}},    {"double", {8, Kind::real}},
      {"int8", {1, Kind::integer}},  {"uint8", {1, Kind::natural}},  {"int16", {2, Kind::integer}}, {"uint16", {2, Kind::natural}},
      {"int32", {4, Kind::integer}}, {"uint32", {4, Kind::natural}}, {"float32", {4, Kind::real}},  {"float64", {8, Kind::real}}};
  const auto found = kTypes.find(name);
  if (found == kTypes.end()) throw InvalidPly("its header has the unknown type \"" + std::string(name) + "\"");
  return found->second;
}

Format format_of(std::string_view word) {
  if (word == "ascii") return Format::ascii;
  if (word == "binary_little_endian") return Format::little_endian;
  if (word == "binary_big_endian") return Format::big_endian;
  throw InvalidPly("its header has the unknown format \"" + std::string(word) + "\"");
}

Property property_of(const std::vector<std::string_view>& words) {
  if (words[1] != "list") return {std::string(words[2]), type_of(words[1]), std::nullopt};
  if (words.size() < 5) throw InvalidPly("its header has a list property without types and name");
  const Type count = type_of(words[2]);
  if (count.kind == Kind::real) throw InvalidPly("its header has a list property whose count is not an integer");
  return {std::string(words[4]), type_of(words[3]), count};
}

void read_header_line(const std::vector<std::string_view>& words, Header& header) {
  if (words[0] == "format" && words.size() > 1) header.format = format_of(words[1]);
  if (words[0] == "element" && words.size() > 2) {
    const std::int64_t count = parse_number<std::int64_t>(words[2]).value_or(-1);
    if (count < 0) throw InvalidPly("its header must give the number of each element");
    if (words[1] == "tristrips") throw InvalidPly("contains triangle strips, which are not supported");
    if (find(header, words[1]) != nullptr) throw InvalidPly("its header has two elements \"" + std::string(words[1]) + "\"");
    header.elements.push_back({.name = std::string(words[1]), .count = count, .properties = {}});
  }
  if (words[0] == "property" && words.size() > 2) {
    if (header.elements.empty()) throw InvalidPly("its header has a property before the first element");
    header.elements.back().properties.push_back(property_of(words));
  }
}

// Where carriage returns alone end lines, a line feed after the header is the first byte of a binary body.
std::string_view take_header_line(std::string_view& rest, bool carriage_returns) {
  if (!carriage_returns) return take_line(rest);
  const std::string_view line = rest.substr(0, rest.find('\r'));
  rest.remove_prefix(std::min(line.size() + 1, rest.size()));
  return line;
}

Header take_header(std::string_view& rest) {
  Header header;
  const bool carriage_returns = rest.starts_with("ply\r") && !rest.starts_with("ply\r\n");
  if (take_header_line(rest, carriage_returns) != "ply") throw InvalidPly("must begin with ply");
  std::vector<std::string_view> words;
  while (!rest.empty()) {
    split_words(take_header_line(rest, carriage_returns), words);
    if (words.empty()) continue;
    if (words[0] == "end_header") {
      if (!header.format) throw InvalidPly("its header does not say whether it is ascii or binary");
      return header;
    }
    read_header_line(words, header);
  }
  throw InvalidPly("is truncated: its header has no end");
}

// Reads the values after the header one after the other. None at the end of the file, or if a word is not a number of the type.
class Body {
 public:
  Body(Format format, std::string_view rest) : format_(format), rest_(rest) {}

  bool skip(const Type& type) {
    if (format_ == Format::ascii) return parse_number<double>(take_word()).has_value();
    if (rest_.size() < type.size) return false;
    rest_.remove_prefix(type.size);
    return true;
  }

  std::optional<std::int64_t> integer(const Type& type) {
    if (type.kind == Kind::real) return std::nullopt;
    if (format_ == Format::ascii) return parse_number<std::int64_t>(take_word());
    const std::optional<std::uint64_t> bits = take_bits(type.size);
    if (!bits) return std::nullopt;
    const auto value = static_cast<std::int64_t>(*bits);
    const std::int64_t range = std::int64_t{1} << (8 * type.size);
    return type.kind == Kind::integer && value >= range / 2 ? value - range : value;
  }

  std::optional<double> number(const Type& type) {
    if (type.kind != Kind::real) {
      const std::optional<std::int64_t> value = integer(type);
      return value ? std::optional(static_cast<double>(*value)) : std::nullopt;
    }
    if (format_ == Format::ascii) return finite_number(take_word());
    const std::optional<std::uint64_t> bits = take_bits(type.size);
    if (!bits) return std::nullopt;
    return type.size == sizeof(float) ? std::bit_cast<float>(static_cast<std::uint32_t>(*bits)) : std::bit_cast<double>(*bits);
  }

 private:
  std::string_view take_word() {
    const auto is_space = [](char c) { return is_blank(c) || c == '\n'; };
    const auto begin = std::find_if_not(rest_.begin(), rest_.end(), is_space);
    const auto end = std::find_if(begin, rest_.end(), is_space);
    rest_ = {end, rest_.end()};
    return {begin, end};
  }

  std::optional<std::uint64_t> take_bits(std::size_t size) {
    if (rest_.size() < size) return std::nullopt;
    std::uint64_t bits = 0;
    for (std::size_t byte = 0; byte < size; ++byte) {
      const std::size_t position = format_ == Format::big_endian ? size - 1 - byte : byte;
      bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(rest_[byte])) << (8 * position);
    }
    rest_.remove_prefix(size);
    return bits;
  }

  Format format_;
  std::string_view rest_;
};

// Reads the elements in the order of the file and writes vertices and faces.
class Elements {
 public:
  Elements(const Header& header, std::string_view rest)
      : header_(header), body_(*header.format, rest), vertices_(checked_vertices(header).count) {}

  CheckedFile read() {
    for (const Element& element : header_.elements) {
      if (element.properties.empty()) continue;
      for (std::int64_t i = 0; i < element.count; ++i) {
        if (read_one(element)) continue;
        throw InvalidPly("is truncated or malformed: it declares " + std::to_string(element.count) + " elements \"" + element.name +
                         "\", but number " + std::to_string(i + 1) + " cannot be read");
      }
    }
    return writer_.finish();
  }

 private:
  // A missing coordinate is an error: assimp would read it as 0.
  static const Element& checked_vertices(const Header& header) {
    const Element* vertex = find(header, "vertex");
    if (vertex == nullptr) throw InvalidPly("has no vertices");
    std::array<bool, 3> found{};
    for (const Property& property : vertex->properties) {
      const std::optional<Index> axis = axis_of(property);
      if (axis && std::exchange(found[*axis], true)) {
        throw InvalidPly("its header has the property \"" + property.name + "\" twice");
      }
    }
    if (std::ranges::count(found, true) < 3) throw InvalidPly("its vertices must have x, y and z");
    return *vertex;
  }

  static std::optional<Index> axis_of(const Property& property) {
    constexpr std::string_view kAxes = "xyz";
    if (property.count || property.name.size() != 1) return std::nullopt;
    const std::size_t axis = kAxes.find(property.name);
    return axis == std::string_view::npos ? std::nullopt : std::optional(static_cast<Index>(axis));
  }

  bool read_one(const Element& element) {
    if (element.name == "vertex") return read_vertex(element);
    corners_.clear();
    for (const Property& property : element.properties) {
      const bool is_face = element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
      if (property.count && is_face ? !read_corners(property) : !skip(property)) return false;
    }
    writer_.add_face(corners_);
    return true;
  }

  bool read_vertex(const Element& element) {
    Vector3 position = Vector3::Zero();
    for (const Property& property : element.properties) {
      const std::optional<Index> axis = axis_of(property);
      if (!axis) {
        if (!skip(property)) return false;
        continue;
      }
      const std::optional<double> value = body_.number(property.type);
      if (!value) return false;
      position[*axis] = *value;
    }
    writer_.add_vertex(position);
    return true;
  }

  bool read_corners(const Property& list) {
    ++face_;
    const std::optional<std::int64_t> count = body_.integer(*list.count);
    if (!count) return false;
    if (*count < 1 || *count > kMostCorners || !corners_.empty()) {
      throw InvalidPly("face " + std::to_string(face_) + " must have one list of 1 to " + std::to_string(kMostCorners) +
                       " corners");
    }
    for (std::int64_t k = 0; k < *count; ++k) {
      const std::optional<std::int64_t> corner = body_.integer(list.type);
      if (!corner) return false;
      if (*corner < 0 || *corner >= vertices_) {
        throw InvalidPly("face " + std::to_string(face_) + " must refer to one of the " + std::to_string(vertices_) + " vertices");
      }
      corners_.push_back(*corner);
    }
    return true;
  }

  bool skip(const Property& property) {
    const std::optional<std::int64_t> count = property.count ? body_.integer(*property.count) : 1;
    if (!count || *count < 0) return false;
    for (std::int64_t i = 0; i < *count; ++i) {
      if (!body_.skip(property.type)) return false;
    }
    return true;
  }

  const Header& header_;
  Body body_;
  PlyWriter writer_;
  std::int64_t vertices_;
  std::int64_t face_ = 0;
  std::vector<std::int64_t> corners_;
};

}  // namespace

CheckedFile checked_ply(const std::filesystem::path& file, const std::string& bytes) {
  FileProblems problems(file);
  try {
    std::string_view rest = bytes;
    const Header header = take_header(rest);
    return Elements(header, rest).read();
  } catch (const InvalidPly& invalid) {
    problems.add("", "", invalid.what(), "export it again");
  }
  problems.throw_if_any();
  return {};
}

}  // namespace sprung
