// The bounded reader of the codec: looks at octets that somebody else owns, never past their end, never allocates.
#pragma once

#include "uadp/octets.hpp"

namespace takt::uadp {

/// Reads from the front. What is not there reads as 0 or as nothing and makes failed() true for good.
class Reader {
 public:
  explicit Reader(Octets source) : source_(source) {}

  template <class T>
  T get() {
    if (left() < sizeof(T)) {
      fail();
      return T{};
    }
    const T value = load_little_endian<T>(source_.data() + used_);
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

  void fail() {
    failed_ = true;
    used_ = source_.size();
  }
  bool failed() const { return failed_; }
  std::size_t left() const { return source_.size() - used_; }
  /// Octets read so far.
  std::size_t position() const { return used_; }
  /// What was read since a former position().
  Octets since(std::size_t position) const { return source_.subspan(position, used_ - position); }
  Octets rest() const { return source_.subspan(used_); }

 private:
  Octets source_;
  std::size_t used_ = 0;
  bool failed_ = false;
};

}  // namespace takt::uadp
