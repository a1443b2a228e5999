// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "analysis/dds_sources.hpp"
#include "analysis/thread_arrivals.hpp"
#include "json/quantity.hpp"
#include "scenario/resolved/resolved_dds.hpp"

namespace takt::analysis {

std::string why_dds_is_late(const scenario::Resolved& resolved, const BoundOptions& options, const HostTimes& hosts,
                            const std::vector<StreamBound>& streams) {
  const Ps within = options.dds_within->ps();
  const DdsTraffic traffic = dds_traffic(resolved, options, hosts);
  for (const scenario::ResolvedParticipant& each : resolved.dds->participants) {
    const scenario::ResolvedApplication& application = resolved.applications[each.application];
    const ThreadTime& cpu = hosts.of(application.node, application.cpu_thread);
    if (!is_bounded(cpu.worst)) return application.name + " may wait for its processor for any time";
    for (const scenario::ResolvedParticipant::Heard& heard : each.hears) {
      const StreamBound& stream = streams[heard.stream.value];
      if (!stream.latency) return stream.name + " may be under way for any time: " + stream.reason;
      if (sum(stream.latency->ps(), cpu.worst) > within)
        return stream.name + " may be under way for " + json::to_text(*stream.latency);
    }
    // Whatever happens meanwhile sets a participant's alarm anew, and its wake-up latency begins again
    // (models::Process::set_alarm).
    const Ps waking = hosts.wake_up(application.node, application.cpu_thread).greatest().ps();
    if (waking == 0) continue;
    std::int64_t disturbances = 1;
    const ClockQuality clock = clock_quality(resolved, application.node, options);
    for (const scenario::ResolvedThread& thread : application.threads)
      disturbances += 2 * calls_of(thread, hosts.of(application.node, thread.cpu_thread), clock).count(within);
    std::int64_t participants = 0;
    for (const scenario::ResolvedParticipant& other : resolved.dds->participants) {
      if (other.application != each.application) continue;
      ++participants;
      for (const DdsSource& source : traffic.sources)
        if (std::ranges::find(other.hears, source.stream, &scenario::ResolvedParticipant::Heard::stream) !=
            other.hears.end())
          disturbances += source.arrivals.is_limited() ? source.arrivals.count(2 * within) : within;
    }
    if (participants > 1)
      return application.name + " has several participants, each of which may keep another one from waking";
    if (sum(product(waking, disturbances), cpu.worst) > within)
      return application.name + " may wake later than " + json::to_text(*options.dds_within);
  }
  return {};
}

}  // namespace takt::analysis
