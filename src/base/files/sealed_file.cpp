#include "base/files/sealed_file.h"

#include "base/error.h"
#include "base/files/binary_archive.h"
#include "base/files/fingerprint.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

namespace sprung {
namespace {

/// Removes a number or a short text from the begin of the bytes. Throws BytesError.
template <class Value>
Value take(std::string_view& bytes) {
  Value value{};
  BinaryReader reader(bytes);
  reader.read(value);
  bytes.remove_prefix(bytes.size() - reader.remaining());
  return value;
}

std::string read_all(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  if (stream.peek() != std::ifstream::traits_type::eof()) bytes << stream.rdbuf();
  if (!stream.is_open() || stream.bad()) throw FileError("read", file.string(), std::strerror(errno));
  return std::move(bytes).str();
}

}  // namespace

std::string sealed(const Seal& seal, std::string_view content) {
  std::string bytes(seal.kind);
  bytes += to_bytes(std::string(seal.version)) + to_bytes(content.size());
  bytes += content;
  return bytes + to_bytes(fingerprint_of(bytes));
}

std::string read_sealed(const std::filesystem::path& file, const Seal& seal) {
  const auto fail = [&](const std::string& reason) {
    throw FileError("read", file.string(), reason + (seal.remedy.empty() ? "" : "; ") + std::string(seal.remedy));
  };
  const std::string all = read_all(file);
  if (!all.starts_with(seal.kind)) fail("it is not " + std::string(seal.what));
  std::string_view rest = std::string_view(all).substr(seal.kind.size());
  try {
    const auto version = take<std::string>(rest);
    const auto size = take<std::size_t>(rest);
    std::uint64_t found = 0;
    const bool is_whole = rest.size() >= sizeof(found) && rest.size() - sizeof(found) == size;
    if (is_whole) std::memcpy(&found, all.data() + all.size() - sizeof(found), sizeof(found));
    const bool is_good = is_whole && found == fingerprint_of(std::string_view(all).substr(0, all.size() - sizeof(found)));
    if (is_good && version != seal.version)
      fail("version " + version + " wrote it, and this is version " + std::string(seal.version));
    if (rest.size() < sizeof(found) || rest.size() - sizeof(found) < size) fail("it is truncated");
    if (!is_good) fail("it is damaged");
    return std::string(rest.substr(0, size));
  } catch (const BytesError&) {
    fail("it is truncated");
  }
  return "";
}

}  // namespace sprung
