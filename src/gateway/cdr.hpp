// XCDR version 1, plain (OMG DDS-XTypes 1.3, 7.4.1): numbers at multiples of their size, counted from behind the encapsulation header.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "uadp/octets.hpp"

namespace takt::gateway {

using uadp::Octets;

/// The encapsulation header of a serialized payload (OMG DDSI-RTPS 2.5, 10.2): CDR_LE, no options.
inline constexpr std::size_t encapsulation_octets = 4;

/// Appends little-endian CDR to octets that are used again.
class CdrWriter {
 public:
  explicit CdrWriter(std::vector<std::byte>& target) : target_(target) {
    target_.assign({std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}});
  }
  void align(std::size_t alignment) {
    const std::size_t over = (target_.size() - encapsulation_octets) % alignment;
    if (over != 0) target_.resize(target_.size() + alignment - over);
  }
  template <class T>
  void put(T number) {
    align(sizeof(T));
    target_.resize(target_.size() + sizeof(T));
    uadp::store_little_endian(target_.data() + target_.size() - sizeof(T), number);
  }
  void put_octets(Octets octets) { target_.insert(target_.end(), octets.begin(), octets.end()); }
  /// Pads to a multiple of 4 and notes how much in the options, as DDSI-RTPS 2.5, 10.2.1 says.
  void finish() {
    const std::size_t padding = (4 - target_.size() % 4) % 4;
    target_.resize(target_.size() + padding);
    target_[3] = static_cast<std::byte>(padding);
  }

 private:
  std::vector<std::byte>& target_;
};

/// Reads CDR of either byte order, never past its end.
class CdrReader {
 public:
  explicit CdrReader(Octets payload) : source_(payload) {
    if (payload.size() < encapsulation_octets || payload[0] != std::byte{0} || payload[1] > std::byte{1}) {
      fail();
      return;
    }
    is_little_ = payload[1] == std::byte{1};
    used_ = encapsulation_octets;
  }
  void align(std::size_t alignment) {
    const std::size_t over = (used_ - encapsulation_octets) % alignment;
    if (over != 0) take(alignment - over);
  }
  template <class T>
  T get() {
    align(sizeof(T));
    const Octets octets = take(sizeof(T));
    if (failed_) return T{};
    if (is_little_) return uadp::load_little_endian<T>(octets.data());
    std::array<std::byte, sizeof(T)> turned;
    std::reverse_copy(octets.begin(), octets.end(), turned.begin());
    return uadp::load_little_endian<T>(turned.data());
  }
  Octets take(std::size_t count) {
    if (failed_ || source_.size() - used_ < count) {
      fail();
      return {};
    }
    used_ += count;
    return source_.subspan(used_ - count, count);
  }
  /// Octets read so far; a former position can be returned to.
  std::size_t position() const { return used_; }
  void return_to(std::size_t position) { used_ = position; }
  void fail() { failed_ = true; }
  bool failed() const { return failed_; }
  std::size_t left() const { return source_.size() - used_; }

 private:
  Octets source_;
  std::size_t used_ = 0;
  bool is_little_ = true;
  bool failed_ = false;
};

}  // namespace takt::gateway
