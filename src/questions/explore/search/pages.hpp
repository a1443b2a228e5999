// SPDX-License-Identifier: Apache-2.0
// A large array of plain numbers that is looked at in no order: on huge pages where the system has them, because
// otherwise each look costs a walk through the page tables, too.
#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <utility>

namespace takt::explore {

class Pages {
 public:
  Pages() = default;
  /// All zero; what is never looked at takes no memory.
  explicit Pages(std::size_t count) : octets_(std::max(count * sizeof(std::uint32_t), std::size_t{1})) {
    void* memory = ::mmap(nullptr, octets_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    numbers_ = static_cast<std::uint32_t*>(memory);
#ifdef MADV_HUGEPAGE
    constexpr std::size_t huge = std::size_t{1} << 21;
    if (octets_ >= 2 * huge)
      static_cast<void>(::madvise(memory, octets_, MADV_HUGEPAGE));  // advice: without it all is right, too
#endif
  }
  Pages(Pages&& other) noexcept : numbers_(std::exchange(other.numbers_, nullptr)), octets_(other.octets_) {}
  Pages& operator=(Pages&& other) noexcept {
    std::swap(numbers_, other.numbers_);
    std::swap(octets_, other.octets_);
    return *this;
  }
  ~Pages() {
    if (numbers_ != nullptr) ::munmap(numbers_, octets_);
  }

  std::uint32_t& operator[](std::size_t i) { return numbers_[i]; }
  const std::uint32_t& operator[](std::size_t i) const { return numbers_[i]; }

 private:
  std::uint32_t* numbers_ = nullptr;
  std::size_t octets_ = 0;
};

}  // namespace takt::explore
