# Makes a C++ source of the text file IN, which viewer_page() returns: cmake -D IN=FILE -D OUT=FILE -P embed.cmake
# The bytes are written as words of eight, the first byte highest: assemblers take minutes for so long a string.
file(READ ${IN} bytes HEX)
string(LENGTH "${bytes}" digits)
math(EXPR size "${digits} / 2")
string(APPEND bytes 00000000000000)
string(REGEX REPLACE "([0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f])" "0x\\1U,\n" words "${bytes}")
string(REGEX REPLACE "\n[0-9a-f]*$" "\n" words "${words}")
file(WRITE ${OUT} "#include \"viewer/page.h\"

#include <cstdint>

namespace sprung {
namespace {

constexpr std::size_t kSize = ${size};
constexpr std::uint64_t kWords[] = {
${words}};

}  // namespace

std::string viewer_page() {
  std::string page(kSize, ' ');
  for (std::size_t k = 0; k < kSize; ++k) page[k] = static_cast<char>((kWords[k / 8] >> (56 - 8 * (k % 8))) & 255U);
  return page;
}

}  // namespace sprung
")
