// SPDX-License-Identifier: Apache-2.0
#include "evaluation/collect_applications.hpp"

#include <cmath>

#include "scenario/applications/dds_node.hpp"
#include "scenario/applications/gateway_bridge.hpp"

namespace takt::evaluation {

using namespace results;
namespace {

std::optional<DurationSummary> summary_of(const scenario::DurationFigures& figures) {
  if (figures.count() == 0) return std::nullopt;
  const double deviation_ps = std::sqrt(figures.variance_ns2()) * 1000.0;
  return DurationSummary{figures.count(), figures.least(), figures.mean(), figures.greatest(),
                         sim::Duration::from_ps(static_cast<std::int64_t>(deviation_ps + 0.5))};
}

CriterionResult criterion_of(const plant::CriterionFigures& figures, sim::Duration window) {
  return {window,           figures.tests,         figures.expected,      figures.counted,
          figures.beyond,   figures.windows_below, figures.windows_above, figures.discarded,
          figures.percent()};
}

ThreadResult result_of(const scenario::ResolvedThread& thread, const std::string& topic,
                       const scenario::ThreadFigures& figures) {
  ThreadResult result;
  result.name = thread.name;
  result.topic = topic;
  result.publishes = thread.publishes;
  result.every = thread.every;
  result.activations = figures.activations;
  result.done = figures.done;
  result.missed = figures.activations - figures.done;
  result.response = summary_of(figures.response);
  result.calls = criterion_of(figures.calls, thread.window);
  result.published = figures.published;
  result.refused = figures.refused;
  result.timed_out = figures.timed_out;
  result.arrived = figures.arrived;
  result.buffered = figures.buffered;
  result.overwritten = figures.overwritten;
  result.lost = figures.lost;
  result.filtered = figures.filtered;
  result.measures_round_trips = figures.round_trip.has_value();
  if (figures.round_trip) result.round_trip = summary_of(*figures.round_trip);
  if (figures.values) result.values = criterion_of(*figures.values, thread.value_window);
  return result;
}

ParticipantResult result_of(const scenario::DdsNode& node) {
  const scenario::ParticipantFigures f = node.figures();
  return {node.settings().config.domain,
          f.messages_sent,
          f.octets_sent,
          f.messages_received,
          f.heartbeats_sent,
          f.acknacks_sent,
          f.resent,
          f.discovery_messages,
          f.discovery_octets,
          f.participants_found,
          f.participants_lost,
          f.matches,
          f.time_to_match,
          f.deadlines_missed,
          f.liveliness_lost,
          f.samples_rejected,
          f.writes_timed_out,
          f.incompatible};
}

BufferResult result_of(const gateway::ChannelFigures& f) {
  return {f.received(),     f.buffer.forwarded, f.buffer.overwritten,
          f.buffer.dropped, f.buffer.stale,     f.mapping_error_total(),
          f.age.least,      f.age.mean(),       f.age.greatest};
}

}  // namespace

std::vector<ApplicationResult> applications_of(const scenario::Run& run, sim::Duration from) {
  const scenario::Resolved& resolved = run.resolved();
  std::vector<ApplicationResult> results;
  for (std::size_t a = 0; a < resolved.applications.size(); ++a) {
    const scenario::ResolvedApplication& application = resolved.applications[a];
    ApplicationResult& result = results.emplace_back();
    result.name = application.name;
    result.node = resolved.topology.nodes[application.node.value].name;
    result.is_gateway = application.gateway.has_value();
    result.is_service = application.service.has_value();
    for (std::size_t t = 0; t < application.threads.size(); ++t)
      result.threads.push_back(result_of(application.threads[t],
                                         resolved.topics[application.threads[t].topic].description->name,
                                         run.thread(a, t, from)));
    const scenario::TopicApplication& live = run.application(a);
    for (const auto& node : live.nodes()) {
      result.participants.push_back(result_of(*node));
      for (const scenario::KeptFigures& kept : node->kept())
        result.kept.push_back({kept.topic, kept.received, kept.restored, kept.kept});
    }
    if (live.bridge() != nullptr) result.buffer = result_of(live.bridge()->figures());
  }
  return results;
}

std::vector<SignalResult> signals_of(const scenario::Run& run, sim::Duration from) {
  std::vector<SignalResult> results;
  for (std::size_t s = 0; s < run.resolved().signals.size(); ++s) {
    const scenario::DigitalOutput& output = run.signal(s);
    SignalResult& result = results.emplace_back();
    result.name = run.resolved().signals[s].name;
    result.nominal = output.pulse();
    const scenario::DigitalOutput::Figures& figures = output.figures(from);
    result.pulses = summary_of(figures.pulses);
    result.periods = summary_of(figures.periods);
    result.irregular_pulses = figures.irregular_pulses;
    result.irregular_periods = figures.irregular_periods;
    for (const scenario::DigitalOutput::Edge& edge : output.edges()) result.edges.emplace_back(edge.at, edge.high);
  }
  return results;
}

}  // namespace takt::evaluation
