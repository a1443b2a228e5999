// What an observer keeps of each run: few values, in rising order, so that equal knowledge is an equal value.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "sim/check.hpp"

namespace takt::explore {

/// `Value` has a member `run`.
template <class Value>
class ByRun {
 public:
  static constexpr std::size_t most_runs = 10;

  const Value* begin() const { return values_.data(); }
  const Value* end() const { return values_.data() + count_; }
  Value* begin() { return values_.data(); }
  Value* end() { return values_.data() + count_; }
  std::size_t size() const { return count_; }
  Value& operator[](std::size_t i) { return values_[i]; }
  const Value& operator[](std::size_t i) const { return values_[i]; }

  /// A new one is all zero but for its run.
  Value& of(std::uint32_t run) {
    std::size_t at = 0;
    while (at < count_ && values_[at].run < run) ++at;
    if (at < count_ && values_[at].run == run) return values_[at];
    TAKT_CHECK(count_ < most_runs, "the runs of an exploration are few: a start costs a call");
    for (std::size_t i = count_; i > at; --i) values_[i] = values_[i - 1];
    ++count_;
    values_[at] = Value{};
    values_[at].run = run;
    return values_[at];
  }

  bool operator==(const ByRun&) const = default;

 private:
  std::uint8_t count_ = 0;
  std::array<Value, most_runs> values_{};
};

}  // namespace takt::explore
