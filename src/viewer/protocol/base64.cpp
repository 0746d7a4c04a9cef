#include "viewer/protocol/base64.h"

namespace sprung {

std::string base64(const Bytes& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::uint32_t second = k + 1 < bytes.size() ? bytes[k + 1] : 0U;
    const std::uint32_t third = k + 2 < bytes.size() ? bytes[k + 2] : 0U;
    const std::uint32_t three = (static_cast<std::uint32_t>(bytes[k]) << 16U) | (second << 8U) | third;
    text += kDigits[three >> 18U];
    text += kDigits[(three >> 12U) & 63U];
    text += k + 1 < bytes.size() ? kDigits[(three >> 6U) & 63U] : '=';
    text += k + 2 < bytes.size() ? kDigits[three & 63U] : '=';
  }
  return text;
}

}  // namespace sprung
