// What a thread has done, for the criteria of its application (plant/criterion.hpp).
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

namespace takt::node {

/// The calls of a thread, each with the time at which the activation was due that it answers: written by the thread, read by the scheduler's.
class ActivityLog {
 public:
  struct Sum {
    std::uint64_t calls = 0;
    std::uint64_t values = 0;
    bool operator==(const Sum&) const = default;
  };

  /// Room for so many calls between two looks; later ones are not noted.
  explicit ActivityLog(std::size_t room = 16'384) : calls_(room) {}

  /// Times come in rising order. `values`: samples that the call took into the buffer of its thread.
  void add(std::int64_t due, std::uint32_t values);
  /// What was done for the activations due from `from` on, before `to`. All before `to` are forgotten.
  Sum take(std::int64_t from, std::int64_t to);

 private:
  struct Call {
    std::int64_t due = 0;
    std::uint32_t values = 0;
  };
  std::mutex mutex_;
  std::vector<Call> calls_;  ///< a ring
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace takt::node
