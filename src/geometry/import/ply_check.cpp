#include "geometry/import/mesh_check.h"
#include "geometry/import/mesh_file.h"
#include "geometry/import/text_words.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

namespace sprung {
namespace {

struct Property {
  std::size_t size = 0;        // bytes of a binary value
  std::size_t count_size = 0;  // bytes of a list's count; 0: not a list
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

enum class Format { ascii, little_endian, big_endian };

struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
};

class InvalidPly : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::size_t size_of(std::string_view type) {
  static const std::map<std::string_view, std::size_t> kSizes{
      {"char", 1}, {"uchar", 1}, {"short", 2}, {"ushort", 2}, {"int", 4},   {"uint", 4},   {"float", 4},   {"double", 8},
      {"int8", 1}, {"uint8", 1}, {"int16", 2}, {"uint16", 2}, {"int32", 4}, {"uint32", 4}, {"float32", 4}, {"float64", 8}};
  const auto found = kSizes.find(type);
  if (found == kSizes.end()) throw InvalidPly("its header has the unknown type \"" + std::string(type) + "\"");
  return found->second;
}

Format format_of(std::string_view word) {
  if (word == "ascii") return Format::ascii;
  if (word == "binary_little_endian") return Format::little_endian;
  if (word == "binary_big_endian") return Format::big_endian;
  throw InvalidPly("its header has the unknown format \"" + std::string(word) + "\"");
}

void read_header_line(const std::vector<std::string_view>& words, Header& header) {
  if (words[0] == "format" && words.size() > 1) header.format = format_of(words[1]);
  if (words[0] == "element" && words.size() > 2) {
    const std::int64_t count = parse_number<std::int64_t>(words[2]).value_or(-1);
    if (count < 0) throw InvalidPly("its header must give the number of each element");
    header.elements.push_back({.name = std::string(words[1]), .count = count, .properties = {}});
  }
  if (words[0] == "property" && words.size() > 2) {
    if (header.elements.empty()) throw InvalidPly("its header has a property before the first element");
    const bool list = words[1] == "list";
    if (list && words.size() < 5) throw InvalidPly("its header has a list property without types and name");
    header.elements.back().properties.push_back(list ? Property{size_of(words[3]), size_of(words[2])}
                                                     : Property{size_of(words[1]), 0});
  }
}

Header take_header(std::string_view& rest) {
  Header header;
  if (take_line(rest) != "ply") throw InvalidPly("must begin with ply");
  std::vector<std::string_view> words;
  while (!rest.empty()) {
    split_words(take_line(rest), words);
    if (words.empty()) continue;
    if (words[0] == "end_header") return header;
    read_header_line(words, header);
  }
  throw InvalidPly("is truncated: its header has no end");
}

// The values after the header, one after the other; false or nothing at the end of the file.
class Body {
 public:
  Body(Format format, std::string_view rest) : format_(format), rest_(rest) {}

  bool skip(std::size_t size) {
    if (format_ == Format::ascii) return parse_number<double>(take_word()).has_value();
    if (rest_.size() < size) return false;
    rest_.remove_prefix(size);
    return true;
  }

  std::optional<std::int64_t> count(std::size_t size) {
    if (format_ == Format::ascii) return parse_number<std::int64_t>(take_word());
    if (rest_.size() < size) return std::nullopt;
    std::int64_t value = 0;
    for (std::size_t byte = 0; byte < size; ++byte) {
      const std::size_t place = format_ == Format::big_endian ? size - 1 - byte : byte;
      value |= static_cast<std::int64_t>(static_cast<unsigned char>(rest_[byte])) << (8 * place);
    }
    rest_.remove_prefix(size);
    return value;
  }

 private:
  std::string_view take_word() {
    const auto is_space = [](char c) { return is_blank(c) || c == '\n'; };
    const auto begin = std::find_if_not(rest_.begin(), rest_.end(), is_space);
    const auto end = std::find_if(begin, rest_.end(), is_space);
    rest_ = {end, rest_.end()};
    return {begin, end};
  }

  Format format_;
  std::string_view rest_;
};

bool skip_element(Body& body, const Element& element) {
  for (const Property& property : element.properties) {
    std::int64_t values = 1;
    if (property.count_size > 0) {
      const std::optional<std::int64_t> count = body.count(property.count_size);
      if (!count || *count < 0) return false;
      values = *count;
    }
    for (std::int64_t i = 0; i < values; ++i) {
      if (!body.skip(property.size)) return false;
    }
  }
  return true;
}

void check_body(const Header& header, std::string_view rest) {
  Body body(header.format, rest);
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;
    for (std::int64_t i = 0; i < element.count; ++i) {
      if (skip_element(body, element)) continue;
      throw InvalidPly("is truncated or malformed: it declares " + std::to_string(element.count) + " elements \"" + element.name +
                       "\", but number " + std::to_string(i + 1) + " cannot be read");
    }
  }
}

}  // namespace

void check_ply(const std::filesystem::path& file, const std::string& bytes) {
  FileProblems problems(file);
  try {
    std::string_view rest = bytes;
    const Header header = take_header(rest);
    check_body(header, rest);
  } catch (const InvalidPly& invalid) {
    problems.add("", "", invalid.what(), "export it again");
  }
  problems.throw_if_any();
}

}  // namespace sprung
