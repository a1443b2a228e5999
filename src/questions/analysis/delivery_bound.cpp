// SPDX-License-Identifier: Apache-2.0
#include "analysis/delivery_bound.hpp"

#include <algorithm>

#include "analysis/flow_graph.hpp"
#include "analysis/thread_arrivals.hpp"
#include "dds/history/history_settings.hpp"
#include "dds/participant/participant_config.hpp"
#include "json/quantity.hpp"
#include "scenario/applications/dds_port.hpp"
#include "scenario/resolved/resolved_dds.hpp"

namespace takt::analysis {
namespace {

using scenario::ResolvedParticipant;
using scenario::ResolvedThread;
using sim::Duration;

class Deliveries {
 public:
  Deliveries(const scenario::Resolved& r, const BoundOptions& options, const Bounds& bounds)
      : r_(r), options_(options), bounds_(bounds) {}

  std::vector<DeliveryBound> make() {
    std::vector<DeliveryBound> all;
    for (std::size_t a = 0; a < r_.applications.size(); ++a)
      for (std::size_t t = 0; t < r_.applications[a].threads.size(); ++t)
        for (const scenario::ResolvedInput& input : r_.applications[a].threads[t].inputs) {
          all.push_back({input.application, input.thread, a, t, {}, {}, {}, {}, false, {}, {}});
          input.stream.is_none() ? over_dds(all.back()) : one_way(bounds_.streams[input.stream.value], all.back());
          if (all.back().repair_reason.empty() && !all.back().repaired)
            all.back().repair_reason = "OPC UA repairs nothing";
        }
    return all;
  }

 private:
  models::NodeIndex node(std::size_t application) const { return r_.applications[application].node; }
  const ThreadTime& cpu(std::size_t application) const {
    return bounds_.hosts->of(node(application), r_.applications[application].cpu_thread);
  }

  void one_way(const StreamBound& stream, DeliveryBound& made) const {
    made.assumptions.add(stream.assumptions);
    made.reaches_all = stream.reaches_all;
    made.loss_reason = stream.loss_reason;
    made.reason = stream.latency ? "" : stream.name + ": " + stream.reason;
    if (!stream.latency) return;
    made.one_way = duration_of(sum(stream.latency->ps(), cpu(made.to_application).worst));
    if (!made.one_way) made.reason = "the thread that takes in what comes: " + cpu(made.to_application).reason;
  }

  /// By which new samples go.
  const StreamBound* stream_of_samples(std::uint32_t from, std::uint32_t to, std::int32_t priority) const {
    const ResolvedParticipant& sender = r_.dds->participants[from];
    if (!sender.config.multicast_group) return stream_between(from, to, priority);
    const dds::Locator group = dds::Locator::udp_v4(
        *sender.config.multicast_group, dds::ports_of(sender.config.domain, sender.config.participant).multicast_user);
    for (const ResolvedParticipant::Route& route : sender.routes)
      if (route.to == group && route.transport_priority == priority) return &bounds_.streams[route.stream.value];
    return nullptr;
  }

  const StreamBound* stream_between(std::uint32_t from, std::uint32_t to, std::int32_t priority) const {
    const ResolvedParticipant& sender = r_.dds->participants[from];
    const ResolvedParticipant& receiver = r_.dds->participants[to];
    const dds::Locator user = dds::Locator::udp_v4(
        receiver.config.address, dds::ports_of(receiver.config.domain, receiver.config.participant).unicast_user);
    for (const ResolvedParticipant::Route& route : sender.routes)
      if (route.to == user && route.transport_priority == priority) return &bounds_.streams[route.stream.value];
    return nullptr;
  }

  void over_dds(DeliveryBound& made) const {
    const ResolvedThread& writer = r_.applications[made.from_application].threads[made.from_thread];
    const ResolvedThread& reader = r_.applications[made.to_application].threads[made.to_thread];
    const dds::WriterConfig config = writer_config(r_.topics[writer.topic], writer);
    const StreamBound* const there =
        stream_of_samples(*writer.participant, *reader.participant, writer.transport_priority);
    const auto nothing = [&](std::string why) { made.reason = made.repair_reason = std::move(why); };
    if (there == nullptr) return nothing("participants of one host do not hear each other");
    if (config.asynchronous) return nothing("what an asynchronous writer sends waits for its flow controller");
    one_way(*there, made);
    if (reader.filter) {
      made.reaches_all = false;
      made.loss_reason = "the filter of the reader may keep samples out";
    }
    made.repair_reason = why_not_repaired(config, reader);
    if (!made.one_way) made.repair_reason = made.reason;
    const StreamBound* const back = stream_between(*reader.participant, *writer.participant, 0);
    if (made.repair_reason.empty() && (back == nullptr || !back->latency))
      made.repair_reason = back == nullptr ? "nothing goes back to the writer" : back->name + ": " + back->reason;
    const StreamBound* const again =
        stream_between(*writer.participant, *reader.participant, writer.transport_priority);
    if (made.repair_reason.empty() && (again == nullptr || !again->latency))
      made.repair_reason = again == nullptr ? "nothing goes to the reader alone" : again->name + ": " + again->reason;
    if (made.repair_reason.empty()) repair(config, writer, *again, *back, made);
  }

  std::string why_not_repaired(const dds::WriterConfig& config, const ResolvedThread& reader) const {
    const dds::DataReaderQos wanted = reader_config(r_.topics[reader.topic], reader).qos;
    if (config.qos.reliability.kind != dds::ReliabilityKind::reliable ||
        wanted.reliability.kind != dds::ReliabilityKind::reliable)
      return "best effort repairs nothing";
    if (!bounds_.dds_within) return "how much participants of DDS send is not known";
    const dds::HistorySettings history = dds::HistorySettings::from(wanted.history, wanted.resource_limits);
    const bool may_refuse = history.max_samples != dds::HistorySettings::no_limit ||
                            history.max_instances != dds::HistorySettings::no_limit ||
                            (history.keep_all && history.per_instance() != dds::HistorySettings::no_limit);
    if (may_refuse) return "the reader may refuse samples for its resource limits";
    return {};
  }

  /// From a timer's expiry to what the participant does then.
  Ps wake(std::size_t application) const {
    return bounds_.hosts->wake_up(node(application), r_.applications[application].cpu_thread).greatest() == Duration()
               ? cpu(application).worst
               : bounds_.dds_within->ps();
  }

  /// `there`: by which samples go again; it is another one than at first if samples go to a group.
  void repair(const dds::WriterConfig& config, const ResolvedThread& writer, const StreamBound& there,
              const StreamBound& back, DeliveryBound& made) const {
    const dds::TimingProfile& timing = r_.dds->participants[*writer.participant].config.timing;
    const ClockQuality own = clock_quality(r_, node(made.from_application), options_);
    const ClockQuality other = clock_quality(r_, node(made.to_application), options_);
    const auto on = [](Duration local, const ClockQuality& clock) {
      return sum(longest(local.ps(), clock), 2 * clock.error);
    };
    const Ps way = std::max(made.one_way->ps(), sum(there.latency->ps(), cpu(made.to_application).worst));
    // The timer of HEARTBEATs runs at the latest from the write on, whose sample is not acknowledged.
    const Ps asked = sum(
        on(std::max(timing.heartbeat_period, timing.heartbeat_period_max), own), wake(made.from_application), way,
        on(std::max(timing.heartbeat_response_delay, timing.nack_delay_when_final), other), wake(made.to_application));
    const Ps again = sum(asked, back.latency->ps(), cpu(made.from_application).worst,
                         on(timing.nack_response_delay, own), wake(made.from_application));
    made.assumptions.add(there.assumptions);
    made.assumptions.add(back.assumptions);
    // A sample that its successors have replaced is not sent again: nor one that has expired.
    const dds::HistorySettings history = dds::HistorySettings::from(config.qos.history, config.qos.resource_limits);
    const std::int64_t written =
        calls_of(writer, bounds_.hosts->of(node(made.from_application), writer.cpu_thread), own).count(again);
    if (!history.keep_all && written > history.per_instance())
      made.repair_reason = "up to " + std::to_string(written) +
                           " samples may be written until one is sent again, and the history keeps " +
                           std::to_string(history.per_instance());
    else if (config.qos.lifespan.duration != dds::infinite && config.qos.lifespan.duration.ps() <= sum(again, way))
      made.repair_reason = "a sample may expire before it is sent again";
    else
      made.repaired = duration_of(sum(again, way));
  }

  const scenario::Resolved& r_;
  const BoundOptions& options_;
  const Bounds& bounds_;
};

}  // namespace

std::vector<DeliveryBound> delivery_bounds(const scenario::Resolved& resolved, const BoundOptions& options,
                                           const Bounds& bounds) {
  return Deliveries(resolved, options, bounds).make();
}

}  // namespace takt::analysis
