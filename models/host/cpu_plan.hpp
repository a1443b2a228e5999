// SPDX-License-Identifier: Apache-2.0
// The processor of a host as plain data: its cores, the threads that share them, and what runs on which thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/distribution.hpp"
#include "sim/time.hpp"

namespace takt::models {

/// How threads share cores, the most urgent policy first, as in Linux: earliest deadline first, then fixed priorities
/// (first in, first out among equals), then fair shares of what is left.
enum class SchedulingPolicy : std::uint8_t { deadline, fifo, fair };

/// One thread. It works off its jobs one by one, in the order in which they came.
struct CpuThreadPlan {
  std::string name;
  SchedulingPolicy policy = SchedulingPolicy::fifo;
  std::uint8_t priority = 0;                                      ///< of fifo: the greatest goes first
  std::optional<sim::Duration> deadline = {};                     ///< after a job's release; there for policy deadline
  std::uint32_t weight = 1024;                                    ///< of fair
  std::optional<std::uint16_t> core = {};                         ///< the only one it runs on; absent: any
  sim::Distribution execution = sim::Distribution::constant({});  ///< of a job, without interruptions
  std::optional<sim::Distribution> wake_up =
      {};  ///< from a timer's expiry until the job of the thread is released; absent: that of the operating system
  sim::Duration non_preemptive = {};  ///< so much at the end of each job nobody interrupts
  std::uint32_t most_waiting = 256;   ///< jobs that wait or are worked at; further ones are lost
  /// A load: a job that is released at offset + n * every on the host's clock and sends nothing.
  struct Load {
    sim::Duration every;
    sim::Duration offset;
    bool operator==(const Load&) const = default;
  };
  std::optional<Load> load = {};
};

struct CpuPlan {
  std::uint16_t cores = 1;
  sim::Duration switching = {};  ///< what a core needs before it goes on with another thread than the last one
  sim::Duration slice =
      sim::Duration::from_ps(3'000'000'000);  ///< how long a fair thread runs before another one of them may
  std::vector<CpuThreadPlan> threads;
  std::optional<std::uint32_t> receive = {};   ///< threads of the protocol stack: each frame that comes is a job
  std::optional<std::uint32_t> transmit = {};  ///< each frame that is sent
  std::optional<std::uint32_t> gptp = {};      ///< each gPTP message that comes
};

}  // namespace takt::models
