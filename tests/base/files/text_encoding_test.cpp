#include "base/files/text_encoding.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace sprung {
namespace {

std::string utf16(std::u16string_view text, bool big_endian) {
  std::string bytes;
  for (const char16_t unit : text) {
    const auto high = static_cast<char>(unit >> 8U);
    const auto low = static_cast<char>(unit & 0xFFU);
    bytes += big_endian ? high : low;
    bytes += big_endian ? low : high;
  }
  return bytes;
}

// One character each of one, two, three and four bytes.
constexpr std::u16string_view kText = u"v 1 \u00E9\u2192\U0001F9F5\r\n";
const std::string kUtf8 = "v 1 \xC3\xA9\xE2\x86\x92\xF0\x9F\xA7\xB5\r\n";

TEST(TextEncoding, Utf16BecomesUtf8) {
  for (const bool big_endian : {false, true}) {
    EXPECT_EQ(utf8_text(utf16(kText, big_endian)), kUtf8);
    EXPECT_EQ(utf8_text(utf16(u"\uFEFF", big_endian) + utf16(kText, big_endian)), kUtf8);
    EXPECT_EQ(utf8_text(utf16(u"\uFEFF\u00E9", big_endian)), "\xC3\xA9");
  }
}

TEST(TextEncoding, Utf8LosesOnlyItsByteOrderMark) {
  EXPECT_EQ(utf8_text(kUtf8), kUtf8);
  EXPECT_EQ(utf8_text("\xEF\xBB\xBF" + kUtf8), kUtf8);
  EXPECT_EQ(utf8_text(""), "");
}

TEST(TextEncoding, HalvesOfSurrogatePairsAreReplaced) {
  const std::u16string text{u'a', u'b', u'c', u'd', 0xD83E, u'e', 0xDDF5, 0xD83E};
  EXPECT_EQ(utf8_text(utf16(text, false)),
            "abcd\xEF\xBF\xBD"
            "e\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST(TextEncoding, OtherBytesRemain) {
  using std::string_literals::operator""s;
  for (const std::string& bytes :
       {"\0\0\0\0\0\0\0\0"s, "glTF\x02\0\0\0"s, "MM\x10\0\0\0\x02\0"s, "s\0o\0l\0"s, "\xFF\xFE\0\0v\0\0\0"s}) {
    EXPECT_EQ(utf8_text(bytes), bytes);
  }
}

}  // namespace
}  // namespace sprung
