// SPDX-License-Identifier: Apache-2.0
#include "node/hand_over.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

namespace takt::node {

Wake::Wake() : fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

void Wake::signal() const {
  const std::uint64_t one = 1;
  static_cast<void>(
      !::write(fd_.number(), &one, sizeof one));  // it fails only if the other side has been woken already
}

void Wake::clear() const {
  std::uint64_t count = 0;
  static_cast<void>(!::read(fd_.number(), &count, sizeof count));
}

void HandOver::report(const Report& report) {
  if (!reports_.put(report)) lost_.fetch_add(1, std::memory_order_relaxed);
  has_reports_ = true;
}

void HandOver::flush() {
  if (!has_reports_) return;
  has_reports_ = false;
  reports_wake_.signal();
}

bool HandOver::call(const Call& call) {
  if (call.method != program::Method::Halt && calls_.size() >= places_of_other_calls) return false;
  if (!calls_.put(call)) return false;
  calls_wake_.signal();
  return true;
}

}  // namespace takt::node
