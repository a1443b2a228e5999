// SPDX-License-Identifier: Apache-2.0
// Counts what the threads of a processor do.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "models/host/cpu.hpp"
#include "scenario/figures/accounts.hpp"
#include "sim/histogram.hpp"

namespace takt::scenario {

/// Of the jobs that were released at an instant or later.
struct CpuThreadFigures {
  sim::Histogram response;
  std::uint64_t late = 0;
  std::uint64_t refused = 0;
  sim::Duration ran;  ///< from that instant on, in true time
};

class CpuMonitor final : public models::CpuObserver {
 public:
  /// Figures are kept from each of the instants on. The processor outlives the monitor's use.
  CpuMonitor(models::Cpu& cpu, std::span<const sim::Duration> instants) : cpu_(&cpu) {
    for (std::size_t t = 0; t < cpu.plan().threads.size(); ++t) threads_.emplace_back(instants);
    cpu.set_observer(this);
  }

  void job_done(std::uint32_t thread, sim::TrueTime released, sim::Duration response, bool in_time) override {
    threads_[thread].add(released, [&](CpuThreadFigures& figures) {
      figures.response.add(response);
      if (!in_time) ++figures.late;
    });
  }
  void job_refused(std::uint32_t thread, sim::TrueTime released) override {
    threads_[thread].add(released, [](CpuThreadFigures& figures) { ++figures.refused; });
  }
  void ran(std::uint32_t thread, sim::Duration time) override {
    threads_[thread].for_each([&](CpuThreadFigures& figures, sim::TrueTime first) {
      const sim::TrueTime now = cpu_->now();
      if (first < now) figures.ran += first.ps() < 0 ? time : std::min(time, now - first);
    });
  }

  const CpuThreadFigures& figures(std::size_t thread, sim::Duration from) const { return threads_[thread].from(from); }

 private:
  const models::Cpu* cpu_;
  std::vector<Accounts<CpuThreadFigures>> threads_;
};

}  // namespace takt::scenario
