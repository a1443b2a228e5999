// The bounded reader of the codec: looks at octets that somebody else owns, never past their end, never allocates.
#pragma once

#include "dds/message/octets.hpp"

namespace takt::dds {

/// Reads from the front. What is not there reads as 0 or as nothing and makes failed() true for good.
class Reader {
 public:
  Reader(Octets source, ByteOrder order) : source_(source), order_(order) {}

  template <Number T>
  T get() {
    if (left() < sizeof(T)) {
      fail();
      return T{};
    }
    const T value = load<T>(source_.data() + used_, order_);
    used_ += sizeof(T);
    return value;
  }

  /// The next `count` octets; none if they are not all there.
  Octets take(std::size_t count) {
    if (left() < count) {
      fail();
      return {};
    }
    const Octets taken = source_.subspan(used_, count);
    used_ += count;
    return taken;
  }
  /// Skips to a multiple of `alignment`, counted from the beginning.
  void align(std::size_t alignment) { take(rounded_up(used_, alignment) - used_); }

  void fail() {
    failed_ = true;
    used_ = source_.size();
  }
  bool failed() const { return failed_; }
  std::size_t left() const { return source_.size() - used_; }
  std::size_t position() const { return used_; }
  Octets rest() const { return source_.subspan(used_); }
  ByteOrder order() const { return order_; }

 private:
  Octets source_;
  ByteOrder order_;
  std::size_t used_ = 0;
  bool failed_ = false;
};

}  // namespace takt::dds
