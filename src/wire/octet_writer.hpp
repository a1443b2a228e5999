// The one bounded writer: little-endian, as OPC UA encodes numbers, into octets that somebody else owns.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace takt::wire {

/// Writes from the front. What does not fit is not written and makes overflowed() true for good.
class OctetWriter {
 public:
  explicit OctetWriter(std::span<std::byte> target) : target_(target) {}

  template <std::unsigned_integral T>
  void put(T value) {
    if (target_.size() - used_ < sizeof(T)) {
      overflowed_ = true;
      return;
    }
    for (std::size_t i = 0; i < sizeof(T); ++i) target_[used_ + i] = static_cast<std::byte>(value >> (8 * i) & 0xFF);
    used_ += sizeof(T);
  }
  void put_zeros(std::size_t count) {
    if (target_.size() - used_ < count) {
      overflowed_ = true;
      return;
    }
    std::fill_n(target_.begin() + static_cast<std::ptrdiff_t>(used_), count, std::byte{0});
    used_ += count;
  }

  bool overflowed() const { return overflowed_; }
  std::span<const std::byte> written() const { return target_.first(used_); }

 private:
  std::span<std::byte> target_;
  std::size_t used_ = 0;
  bool overflowed_ = false;
};

}  // namespace takt::wire
