// The viewer's server: HTTP for the page, a WebSocket for each page that watches.
#pragma once

#include "viewer/protocol/session.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace sprung {

struct ServerSettings {
  std::uint16_t port = 0;  ///< 0: any free one
  std::string token;
  std::string page;  ///< the HTML text
};

class ViewServer {
 public:
  /// Listens on 127.0.0.1. Throws InputError if the port is not free.
  ViewServer(ServerSettings settings, ViewSession& session);
  ~ViewServer();

  /// `http://127.0.0.1:PORT/?token=TOKEN`
  [[nodiscard]] std::string address() const;

  /// Starts the session and serves until `stops` returns true, which is asked twenty times a second. Then stops the session.
  void serve(const std::function<bool()>& stops);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sprung
