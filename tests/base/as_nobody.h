// Tests of file permissions give up root rights, because root may read all files.
#pragma once

#include <unistd.h>

#include <exception>
#include <stdexcept>

namespace sprung::test {

/// Gives up the root rights of the program during its lifetime; does nothing for other users.
class AsNobody {
 public:
  AsNobody() {
    if (was_root_ && ::seteuid(kNobody) != 0) throw std::runtime_error("cannot give up root's rights");
  }
  ~AsNobody() {
    if (was_root_ && ::seteuid(0) != 0) std::terminate();
  }
  AsNobody(const AsNobody&) = delete;
  AsNobody& operator=(const AsNobody&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;
  const bool was_root_ = ::geteuid() == 0;
};

}  // namespace sprung::test
