// Opens an address in the user's browser.
#pragma once

#include <sys/types.h>

#include <string>

namespace sprung {

/// Opens an address in the user's browser, or prints how to open it.
class Browser {
 public:
  /// Starts `xdg-open` with the address and does not wait for it. Prints why and what to do instead if there is no such program,
  /// or neither a screen (DISPLAY, WAYLAND_DISPLAY) nor a browser that is chosen by BROWSER.
  explicit Browser(std::string address);

  /// Prints what to do if `xdg-open` has failed since the last call. Does not wait.
  void check();

 private:
  void start(std::string& program);
  void explain(const std::string& cause) const;

  std::string address_;
  pid_t child_ = -1;  ///< -1: none runs
};

}  // namespace sprung
