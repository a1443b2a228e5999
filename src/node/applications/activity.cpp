#include "node/applications/activity.hpp"

namespace takt::node {

void ActivityLog::add(std::int64_t due, std::uint32_t values) {
  const std::lock_guard lock(mutex_);
  if (count_ == calls_.size()) return;
  calls_[(first_ + count_) % calls_.size()] = {due, values};
  ++count_;
}

ActivityLog::Sum ActivityLog::take(std::int64_t from, std::int64_t to) {
  const std::lock_guard lock(mutex_);
  Sum sum;
  while (count_ > 0 && calls_[first_].due < to) {
    if (calls_[first_].due >= from) {
      ++sum.calls;
      sum.values += calls_[first_].values;
    }
    first_ = (first_ + 1) % calls_.size();
    --count_;
  }
  return sum;
}

}  // namespace takt::node
