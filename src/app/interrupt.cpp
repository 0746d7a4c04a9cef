#include "app/interrupt.h"

#include <csignal>

namespace sprung {
namespace {

volatile std::sig_atomic_t signal_seen = 0;

}  // namespace

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { signal_seen = 1; };
  action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangup {};  // nohup ignores it
  if (::sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return signal_seen != 0; }

}  // namespace sprung
