// SPDX-License-Identifier: Apache-2.0
// A periodic load of a processor: work that other programs of the host do, of which nothing else is known.
#pragma once

#include "models/host/application.hpp"
#include "models/host/cpu_plan.hpp"

namespace takt::models {

/// Releases a job of its thread at offset + n * every on the host's clock, each after the latency of a wake-up. What a
/// wake-up passes over is left out.
class CpuLoad final : public Application {
 public:
  /// `thread`: by which the process knows the thread (HostServices::begin_job).
  CpuLoad(const CpuThreadPlan::Load& load, std::uint32_t thread) : load_(load), thread_(thread) {}

  AlarmId alarm_count() const override { return 2; }
  void start(HostServices& host) override { plan(host); }
  void restart(HostServices& host) override { plan(host); }
  void receive(HostServices&, StreamIndex, std::span<const std::byte>) override {}
  void wake(HostServices& host, AlarmId alarm) override {
    if (alarm == job_is_done) return;
    host.begin_job(thread_, job_is_done);
    plan(host);
  }

 private:
  static constexpr AlarmId release = 0;
  static constexpr AlarmId job_is_done = 1;

  void plan(HostServices& host) {
    const std::int64_t late = host.now().ps() - load_.offset.ps();
    const std::int64_t next = late < 0 ? 0 : late / load_.every.ps() + 1;
    const sim::int128 due = load_.offset.ps() + static_cast<sim::int128>(next) * load_.every.ps();
    host.set_alarm(release, due < sim::LocalTime::never().ps() ? sim::LocalTime::from_ps(static_cast<std::int64_t>(due))
                                                               : sim::LocalTime::never());
  }

  CpuThreadPlan::Load load_;
  std::uint32_t thread_;
};

}  // namespace takt::models
