// SPDX-License-Identifier: Apache-2.0
// Worker processes: each does one job after the other, and what happens to one of them stays there.
//
// A job that crashes, takes too long or takes too much memory is an answer like any other; its process is replaced.
// Workers are forked from this process, so they see its data as it was then; they die when it dies.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/time.hpp"

namespace takt::study {

/// What one job may take; no more than that.
struct JobLimits {
  sim::Duration cpu;
  std::uint64_t octets = 0;
};

struct Answer {
  enum class Kind : std::uint8_t { answered, too_long, too_large, died };
  Kind kind = Kind::answered;
  std::string text;  ///< what the work returned, or why there is none
};

class Pool {
 public:
  /// `work` runs in the workers. It may throw: std::bad_alloc is too_large, another exception is died with its text.
  /// Precondition: this process has one thread while run() forks.
  Pool(unsigned jobs, JobLimits limits, std::function<std::string(std::uint64_t job)> work);
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// Hands out what `next` gives until it gives nothing, and calls `on_answer` here for each as it comes. `idle` is
  /// called at least ten times a second; when it returns false the workers are ended and run() returns, as it does when
  /// on_answer returns false. A text: the workers could not be started.
  std::string run(const std::function<std::optional<std::uint64_t>()>& next,
                  const std::function<bool(std::uint64_t job, const Answer&)>& on_answer,
                  const std::function<bool()>& idle);

 private:
  struct Worker {
    int process = -1;
    int channel = -1;
    std::optional<std::uint64_t> job;
    std::string received;
  };

  bool start(Worker& worker);
  void stop(Worker& worker);
  bool send(Worker& worker, std::uint64_t job);
  std::optional<Answer> receive(Worker& worker);
  Answer post_mortem(Worker& worker);
  [[noreturn]] void serve(int channel);

  JobLimits limits_;
  std::function<std::string(std::uint64_t)> work_;
  std::vector<Worker> workers_;
};

}  // namespace takt::study
