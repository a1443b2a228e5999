// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "node/applications/host.hpp"
#include "node/node_status.hpp"

namespace takt::node {
namespace {

double us_of(sim::Duration duration) { return static_cast<double>(duration.ps()) / 1e6; }

std::string percent_of(const plant::CriterionFigures& figures) {
  const auto percent = figures.percent();
  return percent ? fmt::format("{:.1f} %", *percent) : "-";
}

}  // namespace

std::string to_text(const ApplicationsReport& report) {
  std::string out = fmt::format("  {:<30} {:>9} {:>9} {:>8} {:>8} {:>10} {:>10} {:>12} {:>12}\n", "thread", "every us",
                                "calls", "missed", "taken", "calls", "buffered", "late p99 us", "max us");
  for (const ApplicationStatistics& each : report.all) {
    for (const ThreadStatistics& thread : each.threads)
      out += fmt::format("  {:<30} {:>9} {:>9} {:>8} {:>8} {:>10} {:>10} {:>12.1f} {:>12.1f}\n",
                         each.name + "/" + thread.name, thread.every_ns / 1000, thread.calls, thread.missed,
                         thread.taken, percent_of(thread.call_windows), percent_of(thread.value_windows),
                         static_cast<double>(thread.late.percentile(99)) / 1000,
                         static_cast<double>(thread.late.greatest()) / 1000);
    for (const ThreadStatistics& thread : each.threads)
      if (thread.timed_out + thread.not_sent > 0)
        out += fmt::format("  {}/{}: {} timed out, {} not sent\n", each.name, thread.name, thread.timed_out,
                           thread.not_sent);
    for (const ThreadStatistics& thread : each.threads) {
      if (!thread.signal) continue;
      const application::PulseFigures& figures = thread.signal->figures;
      out += fmt::format("  {} signal {}: {} edges, {} of {} pulses irregular", each.name, thread.signal->name,
                         figures.latency.count(), figures.irregular_pulses, figures.pulses.count());
      if (figures.latency.count() > 0)
        out += fmt::format("; latency mean {:.1f} us, max {:.1f} us", us_of(figures.latency.mean()),
                           us_of(figures.latency.greatest()));
      if (figures.pulses.count() > 0) out += fmt::format("; pulse mean {:.1f} us", us_of(figures.pulses.mean()));
      out += "\n";
    }
    if (!each.channel) continue;
    const gateway::ChannelFigures& figures = *each.channel;
    out += fmt::format(
        "  {} buffer: {} received, {} forwarded, {} overwritten, {} dropped, {} stale, {} not mapped; age mean {:.1f} "
        "us, max {:.1f} us\n",
        each.name, figures.received(), figures.buffer.forwarded, figures.buffer.overwritten, figures.buffer.dropped,
        figures.buffer.stale, figures.mapping_error_total(), static_cast<double>(figures.age.mean().ps()) / 1e6,
        static_cast<double>(figures.age.greatest.ps()) / 1e6);
  }
  return out + sources_text(to_json(report));
}

}  // namespace takt::node
