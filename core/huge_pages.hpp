#pragma once
#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>

namespace layerloop {

/// Allocates on vector boundaries, and asks the system for huge pages where there is enough to fill some: walks through
/// arrays of hundreds of megabytes then miss fewer page translations (320000 grains: 10 % faster).
template <class T>
struct HugePages {
  using value_type = T;
  static constexpr std::size_t page = std::size_t{2} << 20, boundary = 64;

  HugePages() = default;
  template <class U>
  HugePages(HugePages<U> const&) {}

  T* allocate(std::size_t count) {
    std::size_t const bytes = count * sizeof(T), step = bytes >= 4 * page ? page : boundary;
    void* const memory = std::aligned_alloc(step, (bytes + step - 1) / step * step);
    if (!memory) throw std::bad_alloc();
    if (step == page) madvise(memory, bytes, MADV_HUGEPAGE);  // a wish: nothing is lost when it is not granted
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) { std::free(memory); }
  template <class U>
  bool operator==(HugePages<U> const&) const {
    return true;
  }
};

}  // namespace layerloop
