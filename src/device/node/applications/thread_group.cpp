// SPDX-License-Identifier: Apache-2.0
#include "node/applications/thread_group.hpp"

#include <utility>

namespace takt::node {

ThreadGroup::~ThreadGroup() {
  is_over_ = true;
  for (std::thread& thread : threads_)
    if (thread.joinable()) thread.join();
}

void ThreadGroup::start(std::function<void()> work) {
  threads_.reserve(threads_.size() + 1);  // what it throws, it throws before there is a thread that nobody would join
  threads_.emplace_back([this, work = std::move(work)] { run(work); });
}

void ThreadGroup::run(const std::function<void()>& work) noexcept {
  try {
    work();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::current_exception();
    is_over_ = true;
  }
}

void ThreadGroup::join() {
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

}  // namespace takt::node
