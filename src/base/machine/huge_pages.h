// Large arrays in large pages, if the system offers them: fewer address translations for arrays of many megabytes.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <vector>

namespace sprung {

/// Advises the system to use huge pages for `bytes` from `begin` on. Both must be multiples of kHugePage.
void prefer_huge_pages(void* begin, std::size_t bytes);

/// An allocator that requests huge pages for arrays of at least one huge page.
template <class T>
struct HugePageAllocator {
  using value_type = T;  // NOLINT(readability-identifier-naming): the name that allocators must have
  static constexpr std::size_t kHugePage = std::size_t{1} << 21;  ///< [bytes]

  HugePageAllocator() = default;
  template <class U>
  explicit(false) HugePageAllocator(const HugePageAllocator<U>& /*other*/) {}

  [[nodiscard]] T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kHugePage) return std::allocator<T>().allocate(count);
    const std::size_t whole = (bytes + kHugePage - 1) / kHugePage * kHugePage;
    void* const begin = ::operator new (whole, std::align_val_t{kHugePage});
    prefer_huge_pages(begin, whole);
    return static_cast<T*>(begin);
  }
  void deallocate(T* begin, std::size_t count) noexcept {
    if (count * sizeof(T) < kHugePage) {
      std::allocator<T>().deallocate(begin, count);
    } else {
      ::operator delete (begin, std::align_val_t{kHugePage});
    }
  }
  template <class U>
  bool operator==(const HugePageAllocator<U>& /*other*/) const {
    return true;
  }
};

template <class T>
using LargeVector = std::vector<T, HugePageAllocator<T>>;

}  // namespace sprung
