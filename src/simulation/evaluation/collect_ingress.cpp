// SPDX-License-Identifier: Apache-2.0
#include "evaluation/collect_ingress.hpp"

#include <algorithm>

namespace takt::evaluation {

using namespace results;
namespace {

using models::IngressPipeline;

IngressResult result_of(const std::string& node, const IngressPipeline& pipeline) {
  IngressResult result;
  result.node = node;
  result.unidentified = pipeline.unidentified_frames();
  const models::IngressConfig& config = pipeline.config();
  for (std::uint32_t i = 0; i < pipeline.stream_filters().size(); ++i) {
    const models::StreamFilter& filter = pipeline.stream_filters()[models::StreamFilterIndex{i}];
    const models::StreamFilterCounters& c = filter.counters();
    result.filters.push_back(
        {filter.config().stream_handle ? config.streams[filter.config().stream_handle->value] : std::string(),
         filter.config().priority, c.matching_frames, c.passing_frames, c.not_passing_frames, c.passing_sdu,
         c.not_passing_sdu, c.red_frames, filter.stream_blocked_due_to_oversize_frame()});
  }
  for (const models::StreamGate& gate : pipeline.stream_gates())
    result.gates.push_back({gate.config().name, gate.counters().passed, gate.counters().closed,
                            gate.counters().octets_exceeded, gate.closed_due_to_invalid_rx(),
                            gate.closed_due_to_octets_exceeded()});
  for (const IngressPipeline::Meter& meter : pipeline.flow_meters())
    result.meters.push_back({meter.config.name, meter.frames, meter.discarded, meter.meter.mark_all_frames_red()});
  for (const IngressPipeline::Scheduler& scheduler : pipeline.ats_schedulers())
    result.ats.push_back({scheduler.config.name, scheduler.passed, scheduler.discarded, scheduler.longest_hold});
  return result;
}

/// Redundancy alone counts elsewhere.
bool has_met_a_frame(const IngressResult& result) {
  if (result.filters.empty()) return false;
  return result.unidentified > 0 || std::any_of(result.filters.begin(), result.filters.end(),
                                                [](const StreamFilterResult& filter) { return filter.matching > 0; });
}

RecoveryCounters counters_of(const models::SequenceRecoveryCounters& c) {
  return {c.passed_packets,  c.discarded_packets, c.out_of_order_packets, c.rogue_packets, c.really_lost(),
          c.tagless_packets, c.resets - 1};
}

RecoveryResult result_of(const std::string& node, const std::string& stream, const models::StreamRecovery& recovery,
                         const models::LocalClock& clock) {
  RecoveryResult result;
  result.node = node;
  result.stream = stream;
  result.counters = counters_of(recovery.counters());
  if (const models::LatentErrorDetection* const latent = recovery.latent_error_detection()) {
    result.latent_errors = {latent->config().paths, latent->errors(), latent->resets(), std::nullopt};
    if (latent->errors() > 0) result.latent_errors->first = clock.true_at_unstepped(recovery.first_latent_error());
  }
  for (const models::StreamRecovery::Individual& each : recovery.individual())
    result.individual.push_back(
        {each.member == models::StreamRecovery::no_member ? std::nullopt : std::optional(each.member), each.port,
         counters_of(each.recovery.recovery().counters())});
  return result;
}

/// All ports of a node have its clock.
const models::LocalClock& clock_of(const models::Network& network, models::NodeIndex node) {
  const auto ports = network.ports(node);
  return std::find_if(ports.begin(), ports.end(), [](const models::EgressPort& port) { return port.is_connected(); })
      ->clock();
}

}  // namespace

std::vector<IngressResult> ingress_of(const scenario::Run& run) {
  std::vector<IngressResult> results;
  const std::vector<models::NodePlan>& nodes = run.resolved().plan.nodes;
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    const IngressPipeline* const pipeline = run.network().ingress({n});
    if (pipeline == nullptr) continue;
    IngressResult result = result_of(nodes[n].name, *pipeline);
    if (has_met_a_frame(result)) results.push_back(std::move(result));
  }
  return results;
}

RedundancyResult redundancy_of(const scenario::Run& run) {
  RedundancyResult result;
  const models::Network& network = run.network();
  const models::NetworkPlan& plan = run.resolved().plan;
  const sim::TrueTime now = run.simulation().now();
  for (std::uint32_t n = 0; n < plan.nodes.size(); ++n) {
    IngressPipeline* const pipeline = network.ingress({n});
    if (pipeline == nullptr) continue;
    const std::vector<std::string>& streams = pipeline->config().streams;
    for (const IngressPipeline::Split& each : pipeline->splits())
      result.splits.push_back({plan.nodes[n].name, streams[each.stream.value], each.split.config().members.size(),
                               each.split.counters().frames, each.split.counters().copies});
    if (pipeline->config().recoveries.empty()) continue;
    const models::LocalClock& clock = clock_of(network, {n});
    for (const IngressPipeline::Recovery& each : pipeline->recoveries(now))
      result.recoveries.push_back(result_of(plan.nodes[n].name, streams[each.stream.value], each.recovery, clock));
  }
  for (const models::HostSplitPlan& each : plan.host_splits) {
    const models::StreamPlan& stream = plan.streams[each.stream.value];
    const models::StreamSplit& split = *network.output(stream.talker)->redundancy().find(each.stream);
    result.splits.push_back({plan.nodes[stream.talker.value].name, stream.name, split.config().members.size(),
                             split.counters().frames, split.counters().copies});
  }
  for (const models::HostRecoveryPlan& each : plan.host_recoveries) {
    const models::LocalClock& clock = clock_of(network, each.host);
    models::StreamRecovery& recovery = *network.host(each.host)->redundancy().find(each.stream);
    recovery.catch_up(clock.unstepped_at(now));
    result.recoveries.push_back(
        result_of(plan.nodes[each.host.value].name, plan.streams[each.stream.value].name, recovery, clock));
  }
  return result;
}

}  // namespace takt::evaluation
