// The bounded writer of the codec: into octets that somebody else owns; allocates nothing.
#pragma once

#include <algorithm>
#include <cstring>

#include "sim/check.hpp"
#include "uadp/octets.hpp"

namespace takt::uadp {

/// Writes from the front. What does not fit is not written and makes overflowed() true for good.
class Writer {
 public:
  explicit Writer(std::span<std::byte> target) : target_(target) {}

  template <class T>
  void put(T number) {
    if (!has_room(sizeof(T))) return;
    store_little_endian(target_.data() + used_, number);
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

  /// Overwrites a number that was written before.
  template <class T>
  void patch(std::size_t position, T number) {
    TAKT_CHECK(position + sizeof(T) <= used_, "only what was written is patched");
    store_little_endian(target_.data() + position, number);
  }

  /// Takes back what was written after a former position().
  void take_back_to(std::size_t position) {
    TAKT_CHECK(position <= used_, "only what was written is taken back");
    used_ = position;
  }

  bool overflowed() const { return overflowed_; }
  std::size_t position() const { return used_; }
  Octets written() const { return target_.first(used_); }
  /// All that was written; nothing if something did not fit.
  Octets finished() const { return overflowed_ ? Octets() : written(); }

 private:
  bool has_room(std::size_t count) {
    if (!overflowed_ && target_.size() - used_ >= count) [[likely]]
      return true;
    overflowed_ = true;
    return false;
  }

  std::span<std::byte> target_;
  std::size_t used_ = 0;
  bool overflowed_ = false;
};

}  // namespace takt::uadp
