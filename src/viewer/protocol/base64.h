// Bytes as text.
#pragma once

#include "viewer/protocol/message.h"

#include <string>

namespace sprung {

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(const Bytes& bytes);

}  // namespace sprung
