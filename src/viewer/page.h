// The viewer's page, which the build makes from src/viewer/page.
#pragma once

#include <string>

namespace sprung {

/// HTML text with all of its program and style.
[[nodiscard]] std::string viewer_page();

}  // namespace sprung
