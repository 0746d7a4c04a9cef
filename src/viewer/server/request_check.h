// Which requests the viewer answers. It lets programs on this machine that know the token in, and no page of another site.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sprung {

/// What a request says of itself. Absent fields are empty.
struct RequestFacts {
  std::string_view method;
  std::string_view target;  ///< path and query
  std::string_view host;
  std::string_view origin;
};

enum class RequestTarget : std::uint8_t { page, socket, refused };

/// The page for `/`, the socket for `/live`. Refused unless the method is GET, the query holds `token=TOKEN`, the host is 127.0.0.1
/// or localhost with any port (a tunnel may have its own), and the origin, if there is one, is that host by http.
[[nodiscard]] RequestTarget check_request(const RequestFacts& request, std::string_view token);

/// 32 hexadecimal digits from the system's source of randomness.
[[nodiscard]] std::string random_token();

}  // namespace sprung
