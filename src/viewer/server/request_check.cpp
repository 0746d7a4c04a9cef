#include "viewer/server/request_check.h"

#include <algorithm>
#include <cstdint>
#include <random>

namespace sprung {
namespace {

bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

bool is_this_machine(std::string_view host) {
  const std::size_t colon = std::min(host.find(':'), host.size());
  const std::string_view name = host.substr(0, colon);
  const std::string_view port = colon < host.size() ? host.substr(colon + 1) : std::string_view("0");
  return (name == "127.0.0.1" || name == "localhost") && !port.empty() && std::ranges::all_of(port, is_digit);
}

// Compares all letters, so that the time of the comparison tells nothing.
bool are_same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t k = 0; k < a.size(); ++k) difference |= static_cast<unsigned char>(a[k]) ^ static_cast<unsigned char>(b[k]);
  return difference == 0;
}

bool has_token(std::string_view query, std::string_view token) {
  constexpr std::string_view kKey = "token=";
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string_view field = query.substr(0, end);
    if (field.starts_with(kKey)) return are_same(field.substr(kKey.size()), token);
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return false;
}

}  // namespace

RequestTarget check_request(const RequestFacts& request, std::string_view token) {
  constexpr std::string_view kScheme = "http://";
  if (request.method != "GET" || !is_this_machine(request.host)) return RequestTarget::refused;
  if (!request.origin.empty() && (!request.origin.starts_with(kScheme) || request.origin.substr(kScheme.size()) != request.host)) {
    return RequestTarget::refused;
  }
  const std::size_t mark = std::min(request.target.find('?'), request.target.size());
  const std::string_view path = request.target.substr(0, mark);
  if (!has_token(request.target.substr(std::min(mark + 1, request.target.size())), token)) return RequestTarget::refused;
  if (path == "/") return RequestTarget::page;
  if (path == "/live") return RequestTarget::socket;
  return RequestTarget::refused;
}

std::string random_token() {
  constexpr const char* kDigits = "0123456789abcdef";
  std::random_device device;
  std::string token;
  for (int word = 0; word < 4; ++word) {
    for (std::uint32_t bits = device(), k = 0; k < 8; ++k, bits >>= 4) token += kDigits[bits & 15];
  }
  return token;
}

}  // namespace sprung
