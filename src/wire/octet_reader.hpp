// The one bounded reader: never looks past the end, never allocates.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

namespace takt::wire {

/// Reads little-endian numbers from the front. A read past the end gives 0 and makes failed() true for good.
class OctetReader {
 public:
  explicit OctetReader(std::span<const std::byte> source) : source_(source) {}

  template <std::unsigned_integral T>
  T get() {
    if (source_.size() - used_ < sizeof(T)) {
      failed_ = true;
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) value |= static_cast<std::uint64_t>(source_[used_ + i]) << (8 * i);
    used_ += sizeof(T);
    return static_cast<T>(value);
  }

  bool failed() const { return failed_; }
  std::size_t left() const { return source_.size() - used_; }

 private:
  std::span<const std::byte> source_;
  std::size_t used_ = 0;
  bool failed_ = false;
};

}  // namespace takt::wire
