#include "base/files/text_encoding.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

namespace sprung {
namespace {

constexpr char32_t kByteOrderMark = 0xFEFF;
constexpr char32_t kReplacement = 0xFFFD;

/// The units of UTF-16 text, one after the other.
class Utf16Reader {
 public:
  Utf16Reader(std::string_view bytes, bool big_endian) : bytes_(bytes), big_endian_(big_endian) {}

  [[nodiscard]] bool at_end() const { return at_ + 1 >= bytes_.size(); }

  char32_t unit() {
    const auto first = static_cast<unsigned char>(bytes_[at_]);
    const auto second = static_cast<unsigned char>(bytes_[at_ + 1]);
    at_ += 2;
    return big_endian_ ? first << 8U | second : second << 8U | first;
  }

  char32_t character() {
    const char32_t high = unit();
    if (high < 0xD800 || high > 0xDFFF) return high;
    if (high > 0xDBFF || at_end()) return kReplacement;
    const std::size_t before = at_;
    const char32_t low = unit();
    if (low >= 0xDC00 && low <= 0xDFFF) return 0x10000 + ((high - 0xD800) << 10U) + (low - 0xDC00);
    at_ = before;
    return kReplacement;
  }

 private:
  std::string_view bytes_;
  bool big_endian_;
  std::size_t at_ = 0;
};

void append_utf8(std::string& text, char32_t character) {
  if (character < 0x80) {
    text += static_cast<char>(character);
    return;
  }
  constexpr std::array<unsigned, 4> kLeads{0x00, 0xC0, 0xE0, 0xF0};  // by the number of bytes that follow
  const unsigned more = character < 0x800 ? 1 : character < 0x10000 ? 2 : 3;
  text += static_cast<char>(kLeads[more] | character >> 6 * more);
  for (unsigned k = more; k-- > 0;) text += static_cast<char>(0x80U | (character >> 6 * k & 0x3FU));
}

bool is_utf16(std::string_view bytes, bool big_endian) {
  constexpr int kEnough = 4;
  Utf16Reader reader(bytes, big_endian);
  for (int i = 0; i < kEnough; ++i) {
    if (reader.at_end()) return false;
    const char32_t unit = reader.unit();
    if (i == 0 && unit == kByteOrderMark) return !reader.at_end() && reader.unit() != 0;  // 0: UTF-32
    if (unit == 0 || unit > 0x7F) return false;
  }
  return true;
}

/// Whether the text is UTF-16 of big-endian order; none if it is not UTF-16.
std::optional<bool> utf16_order(std::string_view bytes) {
  for (const bool big_endian : {false, true}) {
    if (is_utf16(bytes, big_endian)) return big_endian;
  }
  return std::nullopt;
}

}  // namespace

std::string utf8_text(std::string bytes) {
  constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";
  if (bytes.starts_with(kUtf8Mark)) return bytes.substr(kUtf8Mark.size());
  const std::optional<bool> big_endian = utf16_order(bytes);
  if (!big_endian) return bytes;
  std::string text;
  text.reserve(bytes.size() / 2);
  Utf16Reader reader(bytes, *big_endian);
  while (!reader.at_end()) {
    const char32_t character = reader.character();
    if (character != kByteOrderMark || !text.empty()) append_utf8(text, character);
  }
  return text;
}

bool is_utf32(std::string_view bytes) {
  using std::string_view_literals::operator""sv;
  constexpr std::size_t kUnit = 4;
  const std::string_view first = bytes.substr(0, kUnit);
  if (first == "\xFF\xFE\0\0"sv || first == "\0\0\xFE\xFF"sv) return true;
  return first.size() == kUnit && (first.ends_with("\0\0\0"sv) != first.starts_with("\0\0\0"sv));
}

}  // namespace sprung
