// SPDX-License-Identifier: Apache-2.0
// Threads of processors that nothing comes to, and what is said of them in vain.
#include <algorithm>

#include "scenario/idle/usage.hpp"

namespace takt::scenario {
namespace {

class IdleCpu {
 public:
  IdleCpu(const Usage& usage, std::uint32_t node, const Cpu& cpu, json::Diagnostics& diagnostics)
      : r_(usage.resolved()), usage_(usage), node_(node), cpu_(cpu), diagnostics_(diagnostics) {}

  void tell() {
    const auto is_fair = [](const CpuThread& thread) { return thread.policy == SchedulingPolicy::fair; };
    if (cpu_.where.has("slice") && cpu_.slice != Cpu{}.slice &&
        std::count_if(cpu_.threads.begin(), cpu_.threads.end(), is_fair) < 2)
      warn_once(diagnostics_, cpu_.where.at("slice"), "a slice that nobody shares",
                {json::to_text(cpu_.slice) + " beside fewer than two threads of policy \"fair\"", "two of them"});
    for (const CpuThread& thread : cpu_.threads) tell(thread);
  }

 private:
  void tell(const CpuThread& thread) {
    if (thread.wake_up && thread.runs.empty() && !thread.every)
      warn_once(diagnostics_, thread.wake_up->where.place(), "a wake-up of a thread that no timer wakes",
                {json::quote(thread.name) + ", to which frames alone come", "\"runs\" or \"every\""});
    if (thread.offset && usage_.is_after_the_end(*thread.offset))
      warn_once(diagnostics_, thread.where.at("offset"), "a load that begins after the end of the simulation",
                {json::to_text(*thread.offset), "less than " + json::to_text(r_.scenario.duration)});
    for (std::size_t i = 0; i < thread.stack.size(); ++i) {
      const bool comes = thread.stack[i] == StackPart::gptp ||
                         std::any_of(r_.plan.streams.begin(), r_.plan.streams.end(),
                                     [&](const models::StreamPlan& stream) { return meets(stream, thread.stack[i]); });
      if (!comes)
        warn_once(diagnostics_, thread.where.at("stack", i), "a part of the protocol stack that meets no frame",
                  {std::string(spelling(thread.stack[i])) + " at " + json::quote(r_.topology.nodes[node_].name),
                   thread.stack[i] == StackPart::receive ? "a stream to it" : "a stream from it"});
    }
  }

  bool meets(const models::StreamPlan& stream, StackPart part) const {
    if (part == StackPart::transmit) return stream.talker.value == node_;
    return std::find(stream.listeners.begin(), stream.listeners.end(), models::NodeIndex{node_}) !=
           stream.listeners.end();
  }

  const Resolved& r_;
  const Usage& usage_;
  std::uint32_t node_;
  const Cpu& cpu_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

void report_ineffective_cpus(const Usage& usage, json::Diagnostics& diagnostics) {
  const Topology& topology = usage.resolved().topology;
  for (std::uint32_t n = 0; n < topology.nodes.size(); ++n) {
    const EndStation* const host = end_station_of(topology.nodes[n].description);
    if (host != nullptr && host->cpu) IdleCpu(usage, n, *host->cpu, diagnostics).tell();
  }
}

}  // namespace takt::scenario
