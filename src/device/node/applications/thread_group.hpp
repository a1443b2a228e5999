// SPDX-License-Identifier: Apache-2.0
// Threads that end together. What one of them throws ends all of them and is thrown again where they are joined, so
// that it becomes a message and an exit status instead of the end of the process without a word.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace takt::node {

class ThreadGroup {
 public:
  /// `is_over` becomes true when a thread throws, or when the group ends; each thread looks at it and returns soon
  /// after.
  explicit ThreadGroup(std::atomic<bool>& is_over) : is_over_(is_over) {}
  ThreadGroup(const ThreadGroup&) = delete;
  ThreadGroup& operator=(const ThreadGroup&) = delete;
  ~ThreadGroup();

  /// Throws std::system_error if the machine gives no further thread; those that run are ended by the destructor.
  void start(std::function<void()> work);
  /// Waits for all threads and throws what the first of them to fail has thrown.
  void join();

 private:
  void run(const std::function<void()>& work) noexcept;

  std::atomic<bool>& is_over_;
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::vector<std::thread> threads_;
};

}  // namespace takt::node
