// The bounded writer of the codec: into octets that somebody else owns; allocates nothing.
#pragma once

#include <cstring>

#include "dds/message/octets.hpp"
#include "sim/check.hpp"

namespace takt::dds {

/// Writes from the front. What does not fit is not written and makes overflowed() true until it is taken back.
class Writer {
 public:
  explicit Writer(std::span<std::byte> target, ByteOrder order = ByteOrder::little) : target_(target), order_(order) {}

  template <Number T>
  void put(T number) {
    if (!has_room(sizeof(T))) return;
    store(target_.data() + used_, number, order_);
    used_ += sizeof(T);
  }
  void put_octets(Octets octets) {
    if (!has_room(octets.size()) || octets.empty()) return;
    std::memcpy(target_.data() + used_, octets.data(), octets.size());
    used_ += octets.size();
  }
  void put_zeros(std::size_t count) {
    if (!has_room(count) || count == 0) return;
    std::memset(target_.data() + used_, 0, count);
    used_ += count;
  }
  /// Zeros up to a multiple of `alignment`, counted from `origin`.
  void align(std::size_t alignment, std::size_t origin = 0) { put_zeros(rounded_up(used_ - origin, alignment) - (used_ - origin)); }

  /// Overwrites a number that was written before.
  template <Number T>
  void patch(std::size_t position, T number) {
    TAKT_CHECK(position + sizeof(T) <= used_, "only what was written is patched");
    store(target_.data() + position, number, order_);
  }
  /// Takes back what was written after a former position(), and that it did not fit.
  void take_back_to(std::size_t position) {
    TAKT_CHECK(position <= used_, "only what was written is taken back");
    used_ = position;
    overflowed_ = false;
  }

  bool overflowed() const { return overflowed_; }
  std::size_t position() const { return used_; }
  std::size_t room() const { return target_.size() - used_; }
  ByteOrder order() const { return order_; }
  /// All that was written; nothing if something did not fit.
  Octets finished() const { return overflowed_ ? Octets() : Octets(target_.first(used_)); }

 private:
  bool has_room(std::size_t count) {
    if (!overflowed_ && room() >= count) [[likely]]
      return true;
    overflowed_ = true;
    return false;
  }

  std::span<std::byte> target_;
  ByteOrder order_;
  std::size_t used_ = 0;
  bool overflowed_ = false;
};

}  // namespace takt::dds
