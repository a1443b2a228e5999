// A large array of plain numbers that is looked at in no order: on huge pages where the system has them, because otherwise
// each look costs a walk through the page tables, too.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>

namespace takt::explore {

class Pages {
 public:
  Pages() = default;
  /// All zero.
  explicit Pages(std::size_t count) {
    constexpr std::size_t huge = std::size_t{1} << 21;
    const std::size_t octets = count * sizeof(std::uint32_t);
    const std::size_t alignment = octets < huge ? 64 : huge;
    const std::size_t rounded = (octets + alignment - 1) / alignment * alignment;
    void* memory = std::aligned_alloc(alignment, rounded);
    if (memory == nullptr) throw std::bad_alloc();
    numbers_.reset(static_cast<std::uint32_t*>(memory));
#ifdef MADV_HUGEPAGE
    if (alignment == huge) static_cast<void>(::madvise(memory, rounded, MADV_HUGEPAGE));  // advice: without it all is right, too
#endif
    std::uninitialized_fill_n(numbers_.get(), count, 0U);
  }
  std::uint32_t& operator[](std::size_t i) { return numbers_[i]; }
  const std::uint32_t& operator[](std::size_t i) const { return numbers_[i]; }

 private:
  struct Free {
    void operator()(std::uint32_t* numbers) const { std::free(numbers); }
  };
  std::unique_ptr<std::uint32_t[], Free> numbers_;
};

}  // namespace takt::explore
