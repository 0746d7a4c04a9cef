// Files that may not be read are a matter of who asks: root may read all.
#pragma once

#include <unistd.h>

#include <exception>
#include <stdexcept>

namespace sprung::test {

/// Takes root's rights from the program while it lives; does nothing when it has none.
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
